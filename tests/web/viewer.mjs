// SPDX-License-Identifier: GPL-3.0-or-later
// The viewer's parts that need no browser: node --test viewer.mjs
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { color_map_names, color_table, is_signed, value_range } from '../../web/src/color_maps.js';
import { length_unit, number, round_down, round_length, round_up, ticks } from '../../web/src/format.js';
import { Picker, value_at } from '../../web/src/pick.js';
import { to_csv } from '../../web/src/profiles.js';
import { cut, heights_at } from '../../web/src/section.js';

/** Samples f(x, y) at whole numbers, cells split as height_field_sheet does; middle says where (0, 0) lies. */
function sheet(width, height, f, middle = [0, 0, 0]) {
  const positions = [], corners = [];
  for (let y = 0; y < height; ++y) for (let x = 0; x < width; ++x) positions.push(x, y, f(x, y));
  for (let y = 0; y + 1 < height; ++y) {
    for (let x = 0; x + 1 < width; ++x) {
      const a = y * width + x;
      corners.push(a, a + 1, a + width + 1, a, a + width + 1, a + width);
    }
  }
  return { positions: new Float32Array(positions), corners: new Uint32Array(corners), middle };
}

const cube = {
  positions: new Float32Array([-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1]),
  corners: new Uint32Array([0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 2, 3, 7, 2, 7, 6, 1, 2, 6, 1, 6, 5, 0, 4, 7, 0, 7, 3]),
  middle: [10, 20, 30],
};

test('a section of a plane is exact in every direction', () => {
  const surface = sheet(9, 7, (x, y) => 2 * x - 3 * y, [100, 200, 50]);
  for (const [a, b] of [[[101, 201], [107, 205]], [[107, 205], [101, 201]], [[100, 203], [108, 203]], [[104, 200], [104, 206]],
                        [[100, 200], [106, 206]], [[90, 203.5], [120, 203.5]]]) {
    const lines = cut(surface, a, b), length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    assert.equal(lines.length, 1);
    for (const [s, z] of lines[0]) {
      const [x, y] = [0, 1].map((axis) => a[axis] + s / length * (b[axis] - a[axis]));
      assert.ok(Math.abs(z - (50 + 2 * (x - 100) - 3 * (y - 200))) < 1e-4, `${a} to ${b} at ${s}: ${z}`);
    }
    const ends = [lines[0][0][0], lines[0].at(-1)[0]];
    if (a[0] >= 100 && b[0] <= 108) assert.deepEqual(ends.map((s) => +s.toFixed(6)), [0, +length.toFixed(6)]);
    else assert.deepEqual(ends.map((s) => +s.toFixed(6)), [10, 18]);   // where the surface begins and ends
  }
});

test('a section beside a surface is empty', () => {
  assert.deepEqual(cut(sheet(4, 4, () => 0), [10, 10], [20, 20]), []);
  assert.deepEqual(cut(sheet(4, 4, () => 0), [1, 1], [1, 1]), []);
});

test('a section of a closed body goes round, and is read from above', () => {
  const lines = cut(cube, [8, 20.3], [12, 20.3]);
  const heights = heights_at(lines, 2);
  assert.deepEqual(heights.map((z) => +z.toFixed(6)), [31, 29]);
  const all = lines.flat();
  assert.ok(all.some(([s, z]) => Math.abs(s - 1) < 1e-6 && Math.abs(z - 31) < 1e-6));
  assert.ok(all.some(([s, z]) => Math.abs(s - 3) < 1e-6 && Math.abs(z - 29) < 1e-6));
  assert.deepEqual(heights_at(lines, 0.5), []);
});

test('a section that ends inside a body is cut there', () => {
  const lines = cut(cube, [8, 20.3], [10.5, 20.3]);
  for (const [s] of lines.flat()) assert.ok(s >= 0 && s <= 2.5 + 1e-9);
  assert.deepEqual(heights_at(lines, 2.4).map((z) => +z.toFixed(6)), [31, 29]);
});

test('a hole interrupts a section', () => {
  const surface = sheet(9, 3, () => 1);
  surface.corners = surface.corners.filter((_, i) => ![4 * 6, 12 * 6].includes(i - i % 6));   // one cell of each row
  const lines = cut(surface, [0, 1.5], [8, 1.5]);
  assert.equal(lines.length, 2);
  assert.deepEqual(lines.map((line) => [line[0][0], line.at(-1)[0]].map((s) => +s.toFixed(6))), [[0, 4], [5, 8]]);
});

test('the numbers of a section are saved with their places', () => {
  const section = { a: [0, 0], b: [3, 4] };
  const csv = to_csv([{ name: 'a, "b"', lines: [[[0, 1], [5, 2]]] }], section).trim().split('\n');
  assert.deepEqual(csv, ['surface,piece,distance_nm,z_nm,x_nm,y_nm', '"a, ""b""",1,0,1,0,0', '"a, ""b""",1,5,2,3,4']);
});

test('a ray meets the nearest triangle and its value', () => {
  const surface = sheet(300, 5, (x, y) => x + 10 * y);
  const hit = new Picker(surface).hit([120.25, 2.5, 5000], [0, 0, -1]);
  assert.ok(Math.abs(5000 - hit.t - 145.25) < 1e-3);
  const values = Float32Array.from({ length: 1500 }, (_, i) => i % 300);
  assert.ok(Math.abs(value_at({ values, offset: 1000 }, hit) - 1120.25) < 1e-3);
  assert.equal(new Picker(surface).hit([400, 2, 5], [0, 0, -1]), null);
  const above = new Picker(cube).hit([0.2, 0.1, 5], [0, 0, -1]);
  assert.ok(Math.abs(above.t - 4) < 1e-6);
});

test('numbers, lengths and ticks read well', () => {
  assert.equal(number(-0.0001, 0.1), '0.0');
  assert.equal(number(-3.14159, 0.01), '−3.14');
  assert.equal(number(NaN, 1), '–');
  assert.deepEqual([number(-3e-8, 0.01), number(3e-8, 1e-10), number(2.5e7, 1)], ['0.00', '3.000e−8', '2.500e+7']);
  assert.deepEqual([round_up(3), round_up(0.02), round_down(3), round_down(0.99), round_down(50), round_down(2.5)], [5, 0.02, 2, 0.5, 50, 2]);
  assert.deepEqual([500, 2000, 1e6, 0.5, 0.05].map(round_length), ['500 nm', '2 µm', '1 mm', '0.5 nm', '50 pm']);
  assert.deepEqual([0.05, 500, 9000, 20000, 5e7].map((nm) => length_unit(nm)[0]), ['pm', 'nm', 'nm', 'µm', 'mm']);
  assert.deepEqual(ticks(0, 1000, 5), [0, 200, 400, 600, 800, 1000]);
  assert.deepEqual(ticks(7, 7, 5), [7]);
});

test('ranges leave out outliers and what is not known', () => {
  const values = Float32Array.from({ length: 10000 }, (_, i) => (i === 0 ? 1e6 : i === 1 ? NaN : i % 100));
  const range = value_range([{ values, offset: 5 }], 0, 0.999);
  assert.ok(range.low >= 5 && range.low < 300 && range.most === 1e6 + 5);
  assert.equal(value_range([{ values: new Float32Array([NaN]), offset: 0 }]), null);
  assert.deepEqual(value_range([{ values: new Float32Array([4, 4]), offset: 1 }]), { low: 5, high: 5, least: 5, most: 5 });
  assert.ok(is_signed({ low: -3, high: 4 }) && !is_signed({ low: -1, high: 40 }) && !is_signed({ low: 0, high: 4 }));
});

test('every colour map goes from end to end without a jump', () => {
  for (const name of color_map_names) {
    const table = color_table(name), turned = color_table(name, true);
    for (let c = 0; c < 3; ++c) assert.equal(table[c], turned[4 * 255 + c], name);
    for (let i = 1; i < 256; ++i) for (let c = 0; c < 3; ++c) assert.ok(Math.abs(table[4 * i + c] - table[4 * i - 4 + c]) < 9, name);
  }
});
