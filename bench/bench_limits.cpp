// SPDX-License-Identifier: GPL-3.0-or-later
// Where methods fail (docs/explanation/limits.md): runs sweeps and writes their figures and charts.
//   bench_limits [NAME ...] [--out FOLDER] [--draw] [--list]
// Without names all of them; FOLDER is docs/explanation/limits by default. With --draw charts of
// the figures that are there.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "limits/sweep.h"
#include "surf/io/files.h"
#include "surf/io/plot.h"

int main(int argc, char** argv) {
  using namespace surf;
  std::filesystem::path folder = "docs/explanation/limits";
  std::vector<std::string> names;
  bool draw = false;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--list") {
      for (const limits::Sweep& s : limits::sweeps()) fmt::print("{:<28}{}\n", s.name, s.question);
      return 0;
    }
    if (word == "--out" && i + 1 < argc) folder = argv[++i];
    else if (word == "--draw") draw = true;
    else names.push_back(word);
  }
  for (const std::string& name : names)
    if (std::none_of(limits::sweeps().begin(), limits::sweeps().end(),
                     [&](const auto& s) { return s.name == name; })) {
      fmt::print(stderr, "{}: there is no such sweep; --list shows all\n", name);
      return 2;
    }
  try {
    for (const limits::Sweep& sweep : limits::sweeps()) {
      if (!names.empty() && std::find(names.begin(), names.end(), sweep.name) == names.end())
        continue;
      const std::filesystem::path csv = folder / (sweep.name + ".csv"),
                                  svg = folder / (sweep.name + ".svg");
      if (draw) {
        io::write_plot(svg, sweep.plot(limits::from_csv(io::read_file(csv), csv.string())));
        continue;
      }
      const auto start = std::chrono::steady_clock::now();
      limits::Table table{sweep.columns, {}};
      for (const double value : sweep.values) {
        std::vector<double> row = sweep.at(value);
        row.insert(row.begin(), value);
        fmt::print("{}:", sweep.name);
        for (std::size_t i = 0; i < row.size(); ++i)
          fmt::print(" {}={:.4g}", sweep.columns.at(i), row[i]);
        fmt::print("\n");
        std::fflush(stdout);
        table.rows.push_back(std::move(row));
      }
      io::write_text(csv, limits::to_csv(table));
      io::write_plot(svg, sweep.plot(table));
      fmt::print("{}: {:.1f} s\n", sweep.name,
                 std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 3;
  }
}
