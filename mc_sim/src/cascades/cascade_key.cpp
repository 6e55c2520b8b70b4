// SPDX-License-Identifier: GPL-3.0-or-later
#include "surf/mc/cascades/cascade_key.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "cascades/cascade_format.h"
#include "surf/core/error.h"
#include "surf/core/units.h"
#include "surf/mc/cascades/cascade_library.h"

namespace surf::mc {

namespace {

constexpr const char* what = "cascades of electrons";

// Name and value of each line "name = value"; of a name that comes again, the first.
std::map<std::string, std::string> read_lines(std::string_view text) {
  std::map<std::string, std::string> values;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t at = line.find(" = ");
    if (at != std::string_view::npos) values.emplace(line.substr(0, at), line.substr(at + 3));
  }
  return values;
}

template <class T>
T number(const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size())
    throw InvalidInput("key", "a number cannot be read", "");
  return value;
}

// A number for all that simulations take from the data; FNV-1a over the bits.
std::string digest(const DielectricData& d) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](double value) {
    for (std::uint64_t bits = std::bit_cast<std::uint64_t>(value), i = 0; i < 8; ++i, bits >>= 8)
      hash = (hash ^ (bits & 0xff)) * 0x100000001b3;
  };
  for (const auto* const numbers : {&d.elf.energies_ev(), &d.elf.values(), &d.elf.shells_ev()}) {
    add(static_cast<double>(numbers->size()));
    for (const double value : *numbers) add(value);
  }
  for (const double value :
       {d.band.filled_ev, d.band.gap_ev, d.exhausted_ev, d.vacuum_ev, d.lattice_nm,
        d.resistivity_ohm_m, d.effective_mass, d.density_of_states_mass, d.trap_per_nm, d.trap_ev})
    add(value);
  for (const AcousticBranch& b : d.acoustic)
    for (const double value : {b.speed_m_s, b.deformation_ev, b.bend_m2_s, double(b.count)})
      add(value);
  for (const OpticalMode& m : d.optical)
    for (const double value : {m.energy_ev, m.high_permittivity, m.low_permittivity}) add(value);
  return fmt::format("{:016x}", hash);
}

}  // namespace

std::string cascade_page_key(const CascadeSettings& s, std::size_t number) {
  const Material& m = s.material;
  std::string key = fmt::format(
      "what = {}\nformat = {}\nphysics = {}\ncutoff_ev = {}\n"
      "start_energy_ev = {}\nseed = {}\npage = {}\ncascades = {}\n",
      what, cascade_format_version, format_physics(s.physics),
      format_exact(effective_cutoff_ev(s.physics, m)), format_exact(s.start_energy_ev), s.seed,
      number, CascadeLibrary::page_cascades);
  key += fmt::format(
      "material = {}\ndensity_g_cm3 = {}\nformula_weight_g_mol = {}\nwork_function_ev = {}\n"
      "barrier_ev = {}\nvalence_electrons = {}\nplasmon_ev = {}\nloss_join_ev = {}\n",
      m.name, format_exact(m.density_g_cm3), format_exact(m.formula_weight_g_mol),
      format_exact(m.work_function_ev), format_exact(m.barrier_ev),
      format_exact(m.valence_electrons), format_exact(m.plasmon_ev), format_exact(m.loss_join_ev));
  if (is_dielectric(s.physics)) {
    key += fmt::format("vacuum_barrier_ev = {}\ndielectric = {}\n",
                       format_exact(m.dielectric->barrier_ev()), digest(*m.dielectric));
  }
  for (const Constituent& c : m.constituents)
    key +=
        fmt::format("constituent = {} {} {} {}\n", c.atomic_number, format_exact(c.atomic_weight),
                    format_exact(c.weight_fraction), format_exact(c.mean_ionization_ev));
  return key;
}

std::optional<CascadePageName> read_cascade_page_key(const std::string& key) {
  const auto values = read_lines(key);
  const auto text = [&](const char* name) {
    const auto found = values.find(name);
    if (found == values.end()) throw InvalidInput("key", "a line is missing", "");
    return found->second;
  };
  CascadePageName name;
  try {
    if (text("what") != what) return std::nullopt;
    const std::string page = fmt::format("\npage = {}\n", text("page"));
    name.library = key;
    name.library.erase(key.find(page), page.size() - 1);
    name.number = number<std::size_t>(text("page"));
    name.cascades = number<std::size_t>(text("cascades"));
    name.is_current = number<int>(text("format")) == cascade_format_version &&
                      name.cascades == CascadeLibrary::page_cascades;
    name.material = text("material");
    parse_physics(text("physics"), name.physics);
    const double inside_ev = is_dielectric(name.physics) ? number<double>(text("vacuum_barrier_ev"))
                             : name.physics.barrier == BarrierModel::off
                                 ? 0
                                 : number<double>(text("barrier_ev"));
    const double cutoff_ev = number<double>(text("cutoff_ev"));
    name.is_usual_cutoff = cutoff_ev == effective_cutoff_ev(name.physics, inside_ev);
    name.physics.cutoff_ev = cutoff_ev;
    name.beam_energy_ev = number<double>(text("start_energy_ev")) - inside_ev;
    name.seed = number<std::uint64_t>(text("seed"));
  } catch (const std::exception&) {
    return std::nullopt;  // of another version, which wrote other lines
  }
  return name;
}

}  // namespace surf::mc
