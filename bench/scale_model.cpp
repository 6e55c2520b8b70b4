// SPDX-License-Identifier: GPL-3.0-or-later
// How well a simulation scales over ranks (docs/how-to/many_machines.md): a model of the queue at
// the leader, fed with costs that were measured, checked against runs with two ranks
// (bench/bench_mpi.py), and asked about 16 to 4,096 of them.
//   scale_model [--measure [--quick]] [--out FOLDER]
// FOLDER is docs/development/scaling by default: costs.csv (made by --measure) and mpi.json (made
// by bench_mpi.py) are read, check.csv, scaling.csv and scaling.svg written.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "limits/sweep.h"
#include "scale/measure_costs.h"
#include "scale/share_model.h"
#include "surf/core/error.h"
#include "surf/io/files.h"
#include "surf/io/plot.h"

namespace {

using namespace surf;
using namespace surf::scale;
namespace fs = std::filesystem;

// Assumed, not measured: what a network adds to messages in shared memory. Ten-gigabit Ethernet
// with TCP, and 100 Gb/s with a card that does the work.
struct Network {
  const char* name;
  double latency_s, bytes_per_s, processor_s;
};
constexpr Network networks[] = {{"10 GbE", 30e-6, 1.1e9, 5e-6}, {"100 Gb/s", 2e-6, 11e9, 0.5e-6}};

double at(const limits::Table& table, std::size_t row, const std::string& column) {
  const auto found = std::ranges::find(table.columns, column);
  if (found == table.columns.end())
    throw InvalidInput(column, "there is no such column", "Measure again, by --measure");
  return table.rows.at(row).at(static_cast<std::size_t>(found - table.columns.begin()));
}

UnitCosts costs_of(const limits::Table& table, std::size_t row) {
  UnitCosts out;
  for (int q = 0; q < quantiles; ++q)  // between two quantiles lies the same share of units
    out.durations_s.push_back(0.5 * (at(table, row, fmt::format("q{}_s", q)) +
                                     at(table, row, fmt::format("q{}_s", q + 1))));
  out.merge_s = at(table, row, "merge_s");
  out.unpack_s = at(table, row, "unpack_s");
  out.pack_s = at(table, row, "pack_s");
  out.bytes = at(table, row, "bytes");
  return out;
}

// Handling a tally takes a time of its own and one for each pixel: a line through what was
// measured.
struct Line {
  double at_none = 0, per_pixel = 0;
  double operator()(double pixels) const { return at_none + per_pixel * pixels; }
};
Line line_of(const limits::Table& table, const std::string& column) {
  const auto x = table.column("pixels"), y = table.column(column);
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const auto i = static_cast<std::size_t>(low - x.begin()),
             j = static_cast<std::size_t>(high - x.begin());
  Line out;
  out.per_pixel = (y[j] - y[i]) / (x[j] - x[i]);
  out.at_none = std::max(0.0, y[i] - out.per_pixel * x[i]);
  return out;
}

UnitCosts handling(const limits::Table& table, double pixels, double unit_s, double bytes) {
  UnitCosts out;
  out.merge_s = line_of(table, "merge_s")(pixels);
  out.unpack_s = line_of(table, "unpack_s")(pixels);
  out.pack_s = line_of(table, "pack_s")(pixels);
  out.durations_s = {std::max(1e-7, unit_s - out.merge_s)};  // alone, a process merges its own
  out.bytes = bytes;
  return out;
}

// Of this machine, in shared memory: from the shortest units of all, whose messages are nearly all
// of what they take.
Messages messages_of(const nlohmann::json& figures, const limits::Table& costs) {
  Messages m;
  const auto& shortest = figures.at("stress").at(0);
  const double pixels = shortest.at("pixels_per_unit");
  const double each = 2 * shortest.at("messages_per_unit").get<double>() - 1;  // wants are answered
  const double tally_s = line_of(costs, "merge_s")(pixels) + line_of(costs, "unpack_s")(pixels);
  m.leader_s = std::max(2e-7, (1e-6 * shortest.at("serving_us").get<double>() - tally_s) / each);
  m.follower_s = 1e-6 * shortest.at("sending_us").get<double>();
  m.latency_s = 1e-6;
  m.bytes_per_s = 4e9;
  m.looking_share = 1;  // where there are few messages, all of the time goes into looking for them
  for (const auto& [name, figure] : figures.at("cases").items())
    m.looking_share = std::min(m.looking_share, figure.at("leader_share").get<double>());
  return m;
}

// What two ranks took against what the model says.
limits::Table check(const nlohmann::json& figures, const limits::Table& costs,
                    const Messages& messages) {
  limits::Table table{{"unit_ms", "pixels", "measured_s", "model_s", "bound_s",
                       "measured_efficiency", "model_efficiency", "stress"},
                      {}};
  const auto add = [&](const std::string& name, double units, double pixels, double alone_s,
                       double measured_s, double bytes, int crowd) {
    const UnitCosts c = handling(costs, pixels, alone_s / units, bytes);
    const auto n = static_cast<std::int64_t>(std::lround(units));
    const Sharing model = simulate_sharing(c, messages, {2, 1, crowd}, n),
                  bound = bound_sharing(c, messages, {2, 1, crowd}, n);
    table.rows.push_back({1e3 * alone_s / units, pixels, measured_s, model.seconds, bound.seconds,
                          alone_s / (2 * measured_s), alone_s / (2 * model.seconds),
                          double(crowd > 1)});
    fmt::print(
        "{:<24} unit {:9.3f} ms  measured {:7.3f} s  model {:7.3f} s ({:+.1f} %)  bound {:7.3f} "
        "s\n",
        name, 1e3 * alone_s / units, measured_s, model.seconds,
        100 * (model.seconds / measured_s - 1), bound.seconds);
  };
  for (const auto& [name, f] : figures.at("cases").items())
    if (f.at("units").get<double>() > 0)  // planes take no primaries, by which units are counted
      add(name, f.at("units"), 40, f.at("seconds").at("alone").at(1),
          f.at("seconds").at("ranks_2").at(1), f.at("bytes_per_unit"), 1);
  for (const auto& f : figures.at("stress")) {
    const double units = f.at("units");
    add(fmt::format("{}, {} pixels", f.at("scene").get<std::string>(),
                    f.at("pixels_per_unit").get<int>()),
        units, f.at("pixels_per_unit"), 1e-6 * units * f.at("alone_us").get<double>(),
        1e-6 * units * f.at("ranks_2_us").get<double>(), f.at("bytes_per_unit"),
        f.at("threads_of_rank_1"));
  }
  return table;
}

// Of the whole job, too: every rank builds the scene, the leader sends the library down a tree and
// writes the image.
struct Whole {
  double before_s = 0, after_s = 0;
};
Whole beside(const limits::Table& costs, std::size_t row, const Network& network, int ranks) {
  const double hops = std::ceil(std::log2(std::max(1, ranks)));
  Whole out;
  out.before_s =
      at(costs, row, "scene_s") + hops * (at(costs, row, "library_bytes") / network.bytes_per_s +
                                          at(costs, row, "library_pages") * network.latency_s);
  out.after_s = at(costs, row, "write_s_per_pixel") * side * double{side};
  return out;
}

limits::Table foretell(const limits::Table& costs, const Messages& here,
                       const std::vector<int>& ranks) {
  limits::Table table{
      {"replay", "electrons", "unit_primaries", "gbit_per_s", "threads", "ranks", "efficiency",
       "bound_efficiency", "seconds", "leader_busy", "job_seconds", "job_efficiency"},
      {}};
  for (std::size_t row = 0; row < costs.rows.size(); ++row) {
    const UnitCosts unit = costs_of(costs, row);
    const double electrons = at(costs, row, "electrons"), pixels = at(costs, row, "pixels");
    const auto units = static_cast<std::int64_t>(std::ceil(double{side} * side / pixels));
    for (const Network& network : networks) {
      Messages m = here;
      m.latency_s = network.latency_s;
      m.bytes_per_s = network.bytes_per_s;
      m.leader_s += network.processor_s;
      m.follower_s += network.processor_s;
      for (const int threads : {1, 64})
        for (const int r : ranks) {
          const Sharing s = simulate_sharing(unit, m, {r, threads}, units),
                        b = bound_sharing(unit, m, {r, threads}, units);
          const Sharing one = bound_sharing(unit, m, {1, threads}, units);
          const Whole w = beside(costs, row, network, r), w1 = beside(costs, row, network, 1);
          const double job_s = w.before_s + s.seconds + w.after_s;
          table.rows.push_back({at(costs, row, "replay"), electrons, pixels * electrons,
                                network.bytes_per_s * 8e-9, double(threads), double(r),
                                s.efficiency, b.efficiency, s.seconds, s.leader_busy, job_s,
                                (w1.before_s + one.seconds + w1.after_s) / (r * job_s)});
        }
    }
  }
  return table;
}

io::Plot plot(const limits::Table& table, const limits::Table& checked) {
  io::Plot out;
  out.title = "Efficiency of sharing a 16384 x 16384 image";
  out.columns = 2;
  for (const double electrons : {100., 1000.}) {
    io::PlotPanel panel;
    panel.title = fmt::format("{:.0f} electrons per pixel", electrons);
    panel.x = {"processors (ranks x threads)", true, {}};
    panel.y = {"efficiency", false, io::PlotAxis::Range{0, 1.05}};
    int color = 0;
    for (const bool replay : {false, true})
      for (const int threads : {1, 64}) {
        io::PlotSeries line, dashed;
        for (std::size_t i = 0; i < table.rows.size(); ++i) {
          if (at(table, i, "electrons") != electrons || at(table, i, "replay") != double(replay) ||
              at(table, i, "threads") != threads || at(table, i, "gbit_per_s") > 50)
            continue;
          const double primaries = at(table, i, "unit_primaries");
          if (!replay && (primaries < 10000 || primaries > 20000))
            continue;  // as the program cuts so large an image
          line.x.push_back(at(table, i, "ranks") * threads);
          line.y.push_back(at(table, i, "efficiency"));
          dashed.y.push_back(at(table, i, "bound_efficiency"));
        }
        dashed.x = line.x;
        line.name = fmt::format("{}, {}", replay ? "replay" : "direct",
                                threads == 1 ? "a thread per rank" : "64 threads per rank");
        line.style = io::PlotStyle::line_points;
        line.color = dashed.color = color++;
        dashed.dashed = true;
        panel.series.push_back(line);
        panel.series.push_back(dashed);
      }
    out.panels.push_back(panel);
  }
  io::PlotPanel measured;
  measured.title = "Two ranks: the model and this machine";
  measured.columns = 2;
  measured.x = {"duration of a unit (ms)", true, {}};
  measured.y = {"efficiency", false, io::PlotAxis::Range{0, 1.1}};
  for (const bool model : {false, true}) {
    io::PlotSeries series;
    series.name = model ? "model" : "measured";
    series.style = io::PlotStyle::points;
    series.x = checked.column("unit_ms");
    series.y = checked.column(model ? "model_efficiency" : "measured_efficiency");
    measured.series.push_back(series);
  }
  out.panels.push_back(measured);
  return out;
}

void print(const limits::Table& table) {
  fmt::print(
      "\n| method | electrons | primaries in a unit | network | threads of a rank | 16 ranks | 256 "
      "| 4,096 | leader busy | whole job, 4,096: s |\n"
      "|---|---|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    if (at(table, i, "ranks") != 16) continue;
    const auto of = [&](double ranks) {
      std::size_t j = i;
      while (at(table, j, "ranks") != ranks) ++j;
      return j;
    };
    const auto percent = [&](double ranks) {
      return fmt::format("{:.0f} %", 100 * at(table, of(ranks), "efficiency"));
    };
    fmt::print(
        "| {} | {:.0f} | {:.0f} | {:.0f} Gb/s | {:.0f} | {} | {} | {} | {:.0f} % | {:.0f} |\n",
        at(table, i, "replay") > 0 ? "replay" : "direct", at(table, i, "electrons"),
        at(table, i, "unit_primaries"), at(table, i, "gbit_per_s"), at(table, i, "threads"),
        percent(16), percent(256), percent(4096), 100 * at(table, of(4096), "leader_busy"),
        at(table, of(4096), "job_seconds"));
  }
}

}  // namespace

int main(int argc, char** argv) {
  fs::path folder = "docs/development/scaling";
  bool measure = false, quick = false;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--measure") measure = true;
    else if (word == "--quick") quick = true;
    else if (word == "--out" && i + 1 < argc) folder = argv[++i];
    else {
      fmt::print(stderr, "{}: unknown; scale_model [--measure [--quick]] [--out FOLDER]\n", word);
      return 2;
    }
  }
  try {
    fs::create_directories(folder);
    const fs::path file = folder / "costs.csv";
    if (measure) io::write_text(file, limits::to_csv(measure_costs(folder, quick)));
    const limits::Table costs = limits::from_csv(io::read_file(file), file.string());
    const auto figures = nlohmann::json::parse(io::read_file(folder / "mpi.json"));
    const Messages here = messages_of(figures, costs);
    fmt::print(
        "a message: leader {:.2f} us, other {:.2f} us; looking for them {:.2f} % of a processor\n",
        1e6 * here.leader_s, 1e6 * here.follower_s, 100 * here.looking_share);
    const limits::Table checked = check(figures, costs, here);
    const limits::Table table = foretell(costs, here, {1, 4, 16, 64, 256, 1024, 4096});
    io::write_text(folder / "check.csv", limits::to_csv(checked));
    io::write_text(folder / "scaling.csv", limits::to_csv(table));
    io::write_plot(folder / "scaling.svg", plot(table, checked));
    print(table);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 3;
  }
}
