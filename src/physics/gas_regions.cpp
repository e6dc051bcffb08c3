#include "physics/gas_regions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "core/boundary.hpp"
#include "core/errors.hpp"

namespace quicksand {

namespace {

constexpr int none = GasLabels::no_component;

/// Sums by a pair of numbers; ordered, so that whatever is done with them is done in a fixed order.
using Table = std::map<std::pair<int, int>, double>;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

const Bubble* find(const GasState& gas, int id) {
  const auto found = std::lower_bound(gas.bubbles.begin(), gas.bubbles.end(), id,
                                      [](const Bubble& b, int wanted) { return b.id < wanted; });
  return found != gas.bubbles.end() && found->id == id ? &*found : nullptr;
}

/// Calls body(Cell) for owned cells whose label is not `empty`, in the order of their numbers.
template <int Dim, class Body>
void for_labelled(const Grid<Dim>& grid, const CellLabels& labels, int empty, Body&& body) {
  const Rows<Dim> rows(grid.layout(), grid.cells());
  for (std::ptrdiff_t r = 0; r < rows.count; ++r) {
    for (int i = 0; i < rows.length; ++i) {
      const Cell c{rows.start(r) + i};
      if (labels[c] != empty) body(c);
    }
  }
}

GasPortion ambient_gas(const GasParameters& parameters, double volume) {
  const double pressure = parameters.ambient_pressure;
  return {pressure * volume, parameters.trapped.exponent, volume, pressure};
}

/// What regions before a step and components after it have in common.
struct Overlap {
  Table now;    ///< (region before, component): gas volume after the step that the component has of the region
  Table then;   ///< (region before, component): gas volume before the step in the cells they share
  Table heirs;  ///< (region before, component): gas volume before the step in cells that the component owns now
};

template <int Dim>
Overlap find_overlap(const Grid<Dim>& grid, const GasState& before, const CellField& total_before,
                     const CellField& total, const GasLabels& labels) {
  Overlap overlap;
  Table near;
  for_labelled(grid, labels.component, none, [&](Cell c) {
    const std::pair key{labels.parent[c], labels.component[c]};
    if (key.first == 0) return;
    const bool same_cell = before.region[c] != 0;
    (same_cell ? overlap.now : near)[key] += (1 - total[c]) * grid.volume(c);
    if (same_cell) overlap.then[key] += (1 - total_before[c]) * grid.volume(c);
  });
  for_labelled(grid, before.region, 0, [&](Cell c) {
    overlap.heirs[{before.region[c], labels.owner[c]}] += (1 - total_before[c]) * grid.volume(c);
  });
  // Neighbouring cells speak for a component only where none of its own was gas before.
  std::set<int> known;
  for (const auto& [key, volume] : overlap.now) known.insert(key.second);
  for (const auto& [key, volume] : near) {
    if (known.count(key.second) == 0) overlap.now[key] += volume;
  }
  // The parts that cells share stand for the whole of each component.
  std::map<int, double> seen;
  for (const auto& [key, volume] : overlap.now) seen[key.second] += volume;
  for (auto& [key, volume] : overlap.now) volume *= labels.components[at(key.second)].volume / seen[key.second];
  return overlap;
}

/// Regions after a step as they are put together from components.
struct Assembly {
  std::vector<int> whole;       ///< per component: the component whose region it is part of
  std::vector<double> volume;   ///< per component: of the region, if it is the whole
  std::vector<Cell> held_open;  ///< the emptiest cell of every bubble
};

/// Part-filled cells apart from the rest of their region stay with it; the largest stand for it if there is no rest.
Assembly assemble(const GasLabels& labels, Overlap& overlap) {
  const int n = static_cast<int>(labels.components.size());
  Assembly assembly;
  for (int k = 0; k < n; ++k) assembly.whole.push_back(k);
  std::map<int, int> main;  // region before -> its largest component, one with cells outside D if there is any
  const auto rank = [&](int region, int k) {
    return std::pair(labels.components[at(k)].outside > 0, overlap.now.at({region, k}));
  };
  for (const auto& [key, volume] : overlap.now) {
    const auto [region, k] = key;
    const auto found = main.find(region);
    if (found == main.end() || rank(region, k) > rank(region, found->second)) main[region] = k;
  }
  Table joined;
  for (const auto& [key, volume] : overlap.now) {
    const auto [region, k] = key;
    if (labels.components[at(k)].outside == 0) assembly.whole[at(k)] = main.at(region);
    joined[{region, assembly.whole[at(k)]}] += volume;
  }
  overlap.now = joined;
  assembly.volume.assign(at(n), 0.0);
  for (int k = 0; k < n; ++k) assembly.volume[at(assembly.whole[at(k)])] += labels.components[at(k)].volume;
  for (const auto& [region, k] : main) {
    if (region != open_air) assembly.held_open.push_back(labels.components[at(k)].emptiest);
  }
  return assembly;
}

/// Writes the ids of the regions into their gas cells. \param ids  per component that is a whole region
template <int Dim>
void set_regions(const Grid<Dim>& grid, const GasLabels& labels, const Assembly& assembly, const std::vector<int>& ids,
                 CellLabels& region) {
  region.fill(0);
  for_labelled(grid, labels.component, none,
               [&](Cell c) { region[c] = ids[at(assembly.whole[at(labels.component[c])])]; });
}

/// A part of a bubble's gas and where it goes.
struct Transfer {
  int bubble;
  GasPortion portion;
  bool rest = false;  ///< all the gas of a bubble that has no cells left
};

/// The gas of all bubbles, divided among the components that hold it.
std::vector<std::vector<Transfer>> divide(const GasState& before, const Overlap& overlap, const Assembly& assembly) {
  std::vector<std::vector<Transfer>> into(assembly.whole.size());
  const auto row = [](const Table& table, int region) {
    return std::pair(table.lower_bound({region, none - 1}), table.lower_bound({region + 1, none - 1}));
  };
  for (const Bubble& b : before.bubbles) {
    const auto send = [&](int k, double share, bool rest) {
      into[at(k)].push_back({b.id, {share * b.amount, b.exponent, share * b.volume, b.pressure}, rest});
    };
    const auto [first, last] = row(overlap.now, b.id);
    double whole = 0;
    for (auto part = first; part != last; ++part) whole += part->second;
    for (auto part = first; part != last; ++part) send(part->first.second, part->second / whole, false);
    if (first != last) continue;
    const auto [low, high] = row(overlap.heirs, b.id);
    const auto heir = std::max_element(low, high, [](const auto& x, const auto& y) { return x.second < y.second; });
    if (heir != high && heir->first.second != none) send(assembly.whole[at(heir->first.second)], 1, true);
  }
  return into;
}

/// What the regions are called.
struct Names {
  std::vector<int> id;     ///< per component
  std::vector<int> giver;  ///< the bubble that gave most of a region's gas, 0 if none did
};

/// A region is called after the bubble that gave most of its gas. Where a bubble is the greatest giver to several, the
/// largest of them has its id and the others get new ones.
Names find_names(const std::vector<std::vector<Transfer>>& into, const std::vector<bool>& ambient, int& last_id) {
  Names names{std::vector<int>(into.size(), open_air), std::vector<int>(into.size(), 0)};
  std::map<int, std::pair<double, std::size_t>> largest;
  for (std::size_t k = 0; k < into.size(); ++k) {
    if (ambient[k] || into[k].empty()) continue;
    const auto most = std::max_element(into[k].begin(), into[k].end(), [](const Transfer& x, const Transfer& y) {
      return std::pair(!x.rest, x.portion.amount) < std::pair(!y.rest, y.portion.amount);
    });
    names.giver[k] = most->bubble;
    const auto found = largest.find(most->bubble);
    if (found == largest.end() || most->portion.volume > found->second.first) {
      largest[most->bubble] = {most->portion.volume, k};
    }
  }
  for (std::size_t k = 0; k < into.size(); ++k) {
    const int giver = names.giver[k];
    if (giver != 0) names.id[k] = largest[giver].second == k ? giver : ++last_id;
  }
  return names;
}

/// What the transfer of gas between a bubble and another region, `id`, is. \param giver  gave most of that region's gas
GasEvent describe(const Transfer& transfer, int id, int giver) {
  GasEvent event{GasEventKind::lost, transfer.bubble, 0, transfer.portion.volume, transfer.portion.pressure};
  if (id == open_air) {
    event.kind = transfer.rest ? GasEventKind::lost : GasEventKind::vented;
    return event;
  }
  event.other = id;
  event.kind = transfer.rest              ? GasEventKind::absorbed
               : transfer.bubble == giver ? GasEventKind::split
                                          : GasEventKind::merged;
  return event;
}

/// Bubbles that end without a region to go to.
std::vector<GasEvent> losses(const GasState& before, const std::vector<std::vector<Transfer>>& into) {
  std::set<int> sent;
  for (const std::vector<Transfer>& transfers : into) {
    for (const Transfer& t : transfers) sent.insert(t.bubble);
  }
  std::vector<GasEvent> events;
  for (const Bubble& b : before.bubbles) {
    if (sent.count(b.id) == 0) events.push_back({GasEventKind::lost, b.id, 0, b.volume, b.pressure});
  }
  return events;
}

}  // namespace

std::string_view name(GasEventKind kind) {
  switch (kind) {
    case GasEventKind::born: return "born";
    case GasEventKind::split: return "split";
    case GasEventKind::merged: return "merged";
    case GasEventKind::vented: return "vented";
    case GasEventKind::closed: return "closed";
    case GasEventKind::absorbed: return "absorbed";
    case GasEventKind::lost: return "lost";
  }
  return "";
}

Bubble join(const std::vector<GasPortion>& portions) {
  Bubble bubble;
  double energy = 0;
  double capacity = 0;
  for (const GasPortion& p : portions) {
    bubble.amount += p.amount;
    bubble.volume += p.volume;
    energy += p.pressure * p.volume / (p.exponent - 1);
    capacity += p.amount / (p.exponent - 1);
  }
  bubble.exponent = bubble.amount > 0 ? 1 + bubble.amount / capacity : portions.front().exponent;
  bubble.pressure = (bubble.exponent - 1) * energy / bubble.volume;
  bubble.constant = bubble.pressure * std::pow(bubble.volume, bubble.exponent);
  bubble.mean_pressure = bubble.pressure;
  return bubble;
}

void change_volume(Bubble& bubble, double volume) {
  const auto pressure = [&](double v) { return bubble.constant * std::pow(v, -bubble.exponent); };
  // Simpson's rule for the mean of P over the change of volume.
  const double middle = pressure((bubble.volume + volume) / 2);
  bubble.mean_pressure = (pressure(bubble.volume) + 4 * middle + pressure(volume)) / 6;
  bubble.pressure = pressure(volume);
  bubble.volume = volume;
}

bool has_bubbles(const GasParameters& parameters, const GasState& gas) {
  return parameters.trapped.adiabatic || !gas.bubbles.empty();
}

template <int Dim>
void start_gas(const Domain<Dim>& domain, const GasParameters& parameters, const CellField& total, GasLabels& labels,
               GasState& gas) {
  label_gas(domain, total, parameters.liquid_threshold, gas.region, labels);
  Overlap overlap = find_overlap(domain.grid, gas, total, total, labels);
  const Assembly assembly = assemble(labels, overlap);
  gas.held_open = assembly.held_open;
  std::vector<int> ids(labels.components.size(), open_air);
  for (Bubble& b : gas.bubbles) {
    double volume = 0;
    for (const auto& [key, part] : overlap.now) {
      if (key.first != b.id) continue;
      volume += part;
      int& id = ids[at(key.second)];
      if (id != open_air) {
        throw InputError("bubbles " + std::to_string(id) + " and " + std::to_string(b.id) +
                         " are one on this grid: the liquid between them is thinner than a cell");
      }
      id = b.id;
      if (labels.components[at(key.second)].open) {
        throw InputError("bubble " + std::to_string(b.id) + " is not enclosed by liquid");
      }
    }
    if (!(volume > 0)) throw InputError("bubble " + std::to_string(b.id) + " is smaller than a cell");
    if (b.constant == 0) {
      b.constant = b.pressure * std::pow(volume, b.exponent);
      b.amount = b.pressure * volume;
    }
    b.volume = volume;
    change_volume(b, volume);
  }
  for (std::size_t k = 0; k < ids.size(); ++k) {
    const bool enclosed = assembly.whole[k] == static_cast<int>(k) && ids[k] == open_air && !labels.components[k].open;
    if (!enclosed || !parameters.trapped.adiabatic) continue;
    const double volume = assembly.volume[k];
    Bubble bubble = join({ambient_gas(parameters, volume)});
    bubble.id = ids[k] = ++gas.last_id;
    gas.bubbles.push_back(bubble);
  }
  set_regions(domain.grid, labels, assembly, ids, gas.region);
}

template <int Dim>
std::vector<GasEvent> advance_gas(const Domain<Dim>& domain, const GasParameters& parameters, const GasState& before,
                                  const CellField& total_before, const CellField& total, double dt, GasLabels& labels,
                                  GasState& after) {
  label_gas(domain, total, parameters.liquid_threshold, before.region, labels);
  Overlap overlap = find_overlap(domain.grid, before, total_before, total, labels);
  const Assembly assembly = assemble(labels, overlap);
  const std::vector<std::vector<Transfer>> into = divide(before, overlap, assembly);

  std::vector<bool> ambient(into.size());
  for (std::size_t k = 0; k < into.size(); ++k) {
    const bool region = assembly.whole[k] == static_cast<int>(k);
    const bool holds_bubble = std::any_of(into[k].begin(), into[k].end(), [](const Transfer& t) { return !t.rest; });
    ambient[k] = !region || labels.components[k].open || !(holds_bubble || parameters.trapped.adiabatic);
  }
  after.last_id = before.last_id;
  after.bubbles.clear();
  after.held_open = assembly.held_open;
  Names names = find_names(into, ambient, after.last_id);
  std::vector<GasEvent> events = losses(before, into);
  for (std::size_t k = 0; k < into.size(); ++k) {
    std::vector<GasPortion> portions;
    for (const Transfer& transfer : into[k]) {
      portions.push_back(transfer.portion);
      if (transfer.bubble != names.id[k]) events.push_back(describe(transfer, names.id[k], names.giver[k]));
    }
    if (ambient[k]) continue;
    const std::pair air_part{open_air, static_cast<int>(k)};
    const double volume = assembly.volume[k];
    if (portions.empty()) {
      const bool was_air = overlap.now.count(air_part) > 0;
      names.id[k] = ++after.last_id;
      portions.push_back(ambient_gas(parameters, volume));
      events.push_back(
          {was_air ? GasEventKind::closed : GasEventKind::born, names.id[k], 0, volume, parameters.ambient_pressure});
    } else if (const auto shared = overlap.then.find(air_part); shared != overlap.then.end()) {
      portions.push_back(ambient_gas(parameters, shared->second));
    }
    Bubble bubble = join(portions);
    bubble.id = names.id[k];
    bubble.growth = (volume - bubble.volume) / dt;
    change_volume(bubble, volume);
    after.bubbles.push_back(bubble);
  }
  std::sort(after.bubbles.begin(), after.bubbles.end(), [](const Bubble& a, const Bubble& b) { return a.id < b.id; });
  std::stable_sort(events.begin(), events.end(),
                   [](const GasEvent& a, const GasEvent& b) { return a.bubble < b.bubble; });
  set_regions(domain.grid, labels, assembly, names.id, after.region);
  return events;
}

template <int Dim>
void hold_open(const Grid<Dim>& grid, const GasState& gas, CellMask& liquid) {
  for (const Cell c : gas.held_open) liquid[c] = 0;
  if (!gas.held_open.empty()) wrap(grid.layout(), grid.cells(), liquid, ghosts);
}

template <int Dim>
void gas_pressure_on_nodes(const Domain<Dim>& domain, const GasParameters& parameters, const GasState& gas,
                           const CellMask& liquid, bool mean, NodeField& nodes) {
  nodes.fill(parameters.ambient_pressure);
  if (gas.bubbles.empty()) return;
  const Layout<Dim>& layout = domain.layout();
  CellField cells(layout);
  for_each<Cell>(layout, domain.grid.cells(), [&](Cell c) {
    const Bubble* bubble = find(gas, gas.region[c]);
    cells[c] = bubble == nullptr ? parameters.ambient_pressure : mean ? bubble->mean_pressure : bubble->pressure;
  });
  fill_ghosts(domain.grid, cells, [&](int d, int s) {
    return is_open(domain.sides.at(d, s)) ? GhostRule{0, parameters.ambient_pressure} : GhostRule{1, 0};
  });
  for_each<Node>(layout, domain.grid.nodes(), [&](Node n) {
    double total = 0;
    int count = 0;
    for (int k = 0; k < (1 << Dim); ++k) {
      Cell c = high_cell(n);
      for (int d = 0; d < Dim; ++d) {
        if ((k >> d) & 1) c = c - layout.step(d);
      }
      if (liquid[c]) continue;
      total += cells[c];
      ++count;
    }
    if (count > 0) nodes[n] = total / count;
  });
}

#define QUICKSAND_INSTANTIATE(Dim)                                                                                \
  template void start_gas(const Domain<Dim>&, const GasParameters&, const CellField&, GasLabels&, GasState&);     \
  template std::vector<GasEvent> advance_gas(const Domain<Dim>&, const GasParameters&, const GasState&,           \
                                             const CellField&, const CellField&, double, GasLabels&, GasState&);  \
  template void hold_open(const Grid<Dim>&, const GasState&, CellMask&);                                          \
  template void gas_pressure_on_nodes(const Domain<Dim>&, const GasParameters&, const GasState&, const CellMask&, \
                                      bool, NodeField&);
QUICKSAND_INSTANTIATE(2)
QUICKSAND_INSTANTIATE(3)
#undef QUICKSAND_INSTANTIATE

}  // namespace quicksand
