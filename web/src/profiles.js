// SPDX-License-Identifier: GPL-3.0-or-later
// The profiles of the visible surfaces along the section, and what can be taken from them.
import { cut, heights_at } from './section.js';

export function profiles_of(scene, state) {
  if (!state.section) return [];
  const { a, b } = state.section;
  return scene.surfaces.flatMap((surface, index) => {
    if (!state.visible[index]) return [];
    const lines = cut(surface, a, b);
    return lines.length ? [{ index, name: surface.name, lines, at: (s) => heights_at(lines, s) }] : [];
  });
}

export const length_of = ({ a, b }) => Math.hypot(b[0] - a[0], b[1] - a[1]);

/** One row per corner of the profiles. */
export function to_csv(profiles, section) {
  const length = length_of(section) || 1;
  const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const rows = ['surface,piece,distance_nm,z_nm,x_nm,y_nm'];
  for (const { name, lines } of profiles) {
    lines.forEach((line, piece) => {
      for (const [s, z] of line) {
        const [x, y] = [0, 1].map((axis) => section.a[axis] + s / length * (section.b[axis] - section.a[axis]));
        rows.push([quoted(name), piece + 1, ...[s, z, x, y].map((value) => +value.toPrecision(9))].join());
      }
    });
  }
  return rows.join('\n') + '\n';
}
