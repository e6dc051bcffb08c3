#include "app/bubble_writer.hpp"

namespace quicksand {

namespace {

std::vector<std::string> bubble_columns(int dimension) {
  if (dimension == 3) return {"step", "time", "id", "volume", "pressure", "x", "y", "z", "width"};
  return {"step", "time", "id", "volume", "pressure", "x", "z", "width"};
}

}  // namespace

std::string event_text(const GasEvent& event, double time, double circle) {
  const std::string bubble = "bubble " + std::to_string(event.bubble);
  const std::string other = "bubble " + std::to_string(event.other);
  const auto text = [&]() -> std::string {
    switch (event.kind) {
      case GasEventKind::born: return bubble + " appeared in the liquid";
      case GasEventKind::split: return bubble + " split; " + other + " is new";
      case GasEventKind::merged: return bubble + " merged into " + other;
      case GasEventKind::vented: return bubble + " vented";
      case GasEventKind::closed: return bubble + " closed around ambient gas";
      case GasEventKind::absorbed: return bubble + " shrank to nothing; its gas went to " + other;
      case GasEventKind::lost: return bubble + " shrank to nothing; its gas is lost";
    }
    return bubble + " changed";
  };
  return text() + " at t = " + number_text(time) + " (volume " + number_text(circle * event.volume) + ", pressure " +
         number_text(event.pressure) + ")";
}

template <int Dim>
BubbleWriter<Dim>::BubbleWriter(const std::filesystem::path& folder, std::optional<std::int64_t> last_step)
    : bubbles_(folder / "bubbles.csv", bubble_columns(Dim), last_step),
      events_(folder / "events.csv", {"step", "time", "event", "bubble", "other", "volume", "pressure"}, last_step) {}

template <int Dim>
void BubbleWriter<Dim>::append(const State<Dim>& state, const std::vector<BubbleMeasures<Dim>>& bubbles,
                               const std::vector<GasEvent>& events, double circle) {
  for (const BubbleMeasures<Dim>& b : bubbles) {
    std::vector<double> line = {static_cast<double>(state.step), state.time, static_cast<double>(b.id), b.volume,
                                b.pressure};
    line.insert(line.end(), b.centroid.v, b.centroid.v + Dim);
    line.push_back(b.width);
    bubbles_.append(line);
  }
  for (const GasEvent& e : events) {
    events_.append_text(std::vector<std::string>{
        std::to_string(state.step), number_text(state.time), std::string(name(e.kind)), std::to_string(e.bubble),
        std::to_string(e.other), number_text(circle * e.volume), number_text(e.pressure)});
  }
}

template <int Dim>
void BubbleWriter<Dim>::sync() const {
  bubbles_.sync();
  events_.sync();
}

template class BubbleWriter<2>;
template class BubbleWriter<3>;

}  // namespace quicksand
