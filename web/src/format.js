// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and lengths for people, and round steps for ticks.

/** 1, 2 or 5 times a power of ten, the nearest from above. */
export function round_up(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  const lead = value / power;
  return (lead <= 1.0000001 ? 1 : lead <= 2 ? 2 : lead <= 5 ? 5 : 10) * power;
}

/** The largest of 1, 2, 5 times a power of ten that is no larger. */
export function round_down(value) {
  const power = 10 ** Math.floor(Math.log10(value) + 1e-9);
  const lead = value / power;
  return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power;
}

/** Round values from low to high, about so many. */
export function ticks(low, high, about) {
  if (!(high > low)) return [low];
  const step = round_up((high - low) / Math.max(1, about));
  const values = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) values.push(i * step || 0);   // no -0
  return values;
}

/** As many decimals as a difference of `resolution` needs. */
export function number(value, resolution) {
  if (!Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  if (size >= 1e7 || (size !== 0 && size < 1e-5 && size >= resolution)) return value.toExponential(3).replace('-', '−');
  const decimals = resolution > 0 ? Math.min(8, Math.max(0, Math.ceil(-Math.log10(resolution) - 1e-9))) : 3;
  const text = value.toFixed(decimals);
  return (Number(text) === 0 ? text.replace('-', '') : text).replace('-', '−');
}

const units = [['m', 1e9], ['mm', 1e6], ['µm', 1e3], ['nm', 1], ['pm', 1e-3]];

/** The unit in which lengths up to `largest_nm` read well: [name, nm]. */
export function length_unit(largest_nm) {
  if (largest_nm < 0.1) return ['pm', 1e-3];
  if (largest_nm < 1e4) return ['nm', 1];
  return units.find(([, nm]) => largest_nm >= 10 * nm) ?? ['nm', 1];
}

/** "500 nm", "2 µm": a round length. */
export function round_length(nm) {
  const [unit, size] = nm >= 1000 ? units.find(([, s]) => nm >= s * 0.9999) : nm >= 0.1 ? ['nm', 1] : ['pm', 1e-3];
  return `${Number((nm / size).toPrecision(6))} ${unit}`;
}

/** "nm" or, of plain numbers, nothing. */
export const with_unit = (text, unit) => (unit && unit !== '1' ? `${text} ${unit}` : text);
