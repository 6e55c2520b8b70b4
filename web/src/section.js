// SPDX-License-Identifier: GPL-3.0-or-later
// Where a vertical plane cuts a surface: lines of [distance from a, z] in nm.

/** Crossings of the plane with the edges of triangles, joined to lines and cut to the length from a to b. */
export function cut(surface, a, b) {
  const { positions, corners, middle } = surface;
  const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
  if (!(length > 0)) return [];
  const ex = (b[0] - a[0]) / length, ey = (b[1] - a[1]) / length;
  const ax = a[0] - middle[0], ay = a[1] - middle[1];
  const count = positions.length / 3;
  const side = new Float64Array(count);   // distance from the plane; exactly on it counts as left of it
  for (let i = 0; i < count; ++i) side[i] = (positions[3 * i] - ax) * -ey + (positions[3 * i + 1] - ay) * ex;

  const pieces = new Map();   // an edge that is crossed, to its point and the edges reached from it
  const point_at = (i, j) => {
    const low = Math.min(i, j), high = Math.max(i, j), key = low * count + high;
    let point = pieces.get(key);
    if (!point) {
      const t = side[low] / (side[low] - side[high]);
      const at = (axis) => positions[3 * low + axis] + t * (positions[3 * high + axis] - positions[3 * low + axis]);
      point = { s: (at(0) - ax) * ex + (at(1) - ay) * ey, z: at(2) + middle[2], next: [] };
      pieces.set(key, point);
    }
    return point;
  };
  for (let i = 0; i < corners.length; i += 3) {
    const p = corners[i], q = corners[i + 1], r = corners[i + 2];
    const left_p = side[p] >= 0, left_q = side[q] >= 0, left_r = side[r] >= 0;
    if (left_p === left_q && left_q === left_r) continue;
    const ends = [];
    if (left_p !== left_q) ends.push(point_at(p, q));
    if (left_q !== left_r) ends.push(point_at(q, r));
    if (left_r !== left_p) ends.push(point_at(r, p));
    if (ends[0].s < -length && ends[1].s < -length) continue;
    ends[0].next.push(ends[1]);
    ends[1].next.push(ends[0]);
  }
  return trim(join([...pieces.values()]), length);
}

function join(points) {
  const lines = [];
  const follow = (start) => {
    const line = [start];
    for (let point = start; ;) {
      const next = point.next.find((candidate) => !candidate.used || (candidate === start && line.length > 2));
      point.used = true;
      if (!next) break;
      line.push(next);
      if (next === start || next.used) break;
      point = next;
    }
    lines.push(line);
  };
  for (const point of points) if (!point.used && point.next.length !== 2) follow(point);   // rims first
  for (const point of points) if (!point.used) follow(point);
  return lines.map((line) => line.map(({ s, z }) => [s, z]));
}

function trim(lines, length) {
  const inside = [];
  for (const line of lines) {
    let now = [];
    const close = () => {
      if (now.length > 1) inside.push(now);
      now = [];
    };
    for (let i = 0; i < line.length; ++i) {
      const [s, z] = line[i];
      if (i > 0) {
        const [s0, z0] = line[i - 1];
        const on_the_way = [0, length].map((limit) => (limit - s0) / (s - s0)).filter((t) => t > 0 && t < 1).sort((p, q) => p - q);
        for (const t of on_the_way) {
          const point = [s0 + t * (s - s0), z0 + t * (z - z0)];
          now.push(point);
          const after = s0 + (t + 1e-9) * (s - s0);
          if (after < 0 || after > length) close();
          else now = now.length > 1 ? now : [point];
        }
      }
      if (s >= 0 && s <= length) now.push([s, z]);
    }
    close();
  }
  for (const line of inside) if (line[0][0] > line[line.length - 1][0]) line.reverse();
  return inside.sort((p, q) => p[0][0] - q[0][0]);
}

/** All heights of the lines at a distance, highest first. */
export function heights_at(lines, s) {
  const found = [];
  for (const line of lines) {
    for (let i = 1; i < line.length; ++i) {
      const [s0, z0] = line[i - 1], [s1, z1] = line[i];
      if (s < Math.min(s0, s1) || s > Math.max(s0, s1)) continue;
      const z = s1 === s0 ? Math.max(z0, z1) : z0 + (s - s0) / (s1 - s0) * (z1 - z0);
      if (!found.some((other) => Math.abs(other - z) < 1e-9 * (1 + Math.abs(z)))) found.push(z);
    }
  }
  return found.sort((p, q) => q - p);
}
