#include "app/case_codec.hpp"
#include "app/crater_codec.hpp"

namespace quicksand {

Codec<OutputSettings> output_codec() {
  namespace dim = dimension;
  const auto schedule = object<OutputSchedule>({
      maybe("every", &OutputSchedule::every, quantity(dim::time, positive),
            {"interval (or give times)", "20 to 100 outputs a run", {"0.05 s"}}),
      maybe("times", &OutputSchedule::times, list_of(quantity(dim::time, not_negative), 1),
            {"increasing list of times (or give every)", "", {"[0, 0.1 s, 0.5 s]"}}),
  });
  const auto checkpoint = object<CheckpointSettings>({
      maybe("every", &CheckpointSettings::every, quantity(dim::time, positive),
            {"interval in the time of the flow; with it the last checkpoint outlasts the run",
             "a tenth of the run",
             {"0.5 s"}}),
      defaulted("wall_interval", &CheckpointSettings::wall_interval, quantity(dim::time, positive),
                {"interval in seconds of the clock on the wall", "900, a quarter of an hour"}),
  });
  return object<OutputSettings>({
      defaulted("directory", &OutputSettings::directory, text(),
                {"folder of the results, relative to the current one", "", {"results/mud"}}),
      defaulted("fields", &OutputSettings::fields, schedule, "when fields are written; neither key: start and end"),
      defaulted("checkpoint", &OutputSettings::checkpoint, checkpoint,
                "when checkpoints are written, from which an interrupted run goes on"),
      defaulted("history", &OutputSettings::history, flag(), "whether history.csv is written"),
      maybe("crater", &OutputSettings::crater, crater_codec(), "the crater in a bed, measured"),
  });
}

}  // namespace quicksand
