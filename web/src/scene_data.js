// SPDX-License-Identifier: GPL-3.0-or-later
// What the page holds (io/src/web_page_data.cpp writes it), as typed arrays in nm.

function bytes_of(id) {
  const element = document.getElementById(`data${id}`);
  const text = element.textContent;
  element.remove();   // its text need not stay in memory
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

async function numbers_of({ data, type, count }) {
  const stream = new Blob([bytes_of(data)]).stream().pipeThrough(new DecompressionStream('deflate'));
  const planes = new Uint8Array(await new Response(stream).arrayBuffer());
  if (planes.length !== 4 * count) throw new Error(`the data of this page are damaged (part ${data})`);
  const words = new Uint32Array(count);
  for (let i = 0, sum = 0; i < count; ++i) {
    const difference = planes[i] | planes[count + i] << 8 | planes[2 * count + i] << 16 | planes[3 * count + i] << 24;
    words[i] = sum = (sum + difference) | 0;
  }
  return type === 'float32' ? new Float32Array(words.buffer) : words;
}

/** Triangles over the samples, each cell split from lower-left to upper-right; none beside a hole. */
function triangles_of_grid(width, height, z) {
  const corners = new Uint32Array(6 * (width - 1) * (height - 1));
  let n = 0;
  for (let y = 0; y + 1 < height; ++y) {
    for (let x = 0; x + 1 < width; ++x) {
      const a = y * width + x, b = a + 1, c = a + width, d = c + 1;
      const diagonal = z[a] === z[a] && z[d] === z[d];
      if (diagonal && z[b] === z[b]) { corners[n++] = a; corners[n++] = b; corners[n++] = d; }
      if (diagonal && z[c] === z[c]) { corners[n++] = a; corners[n++] = d; corners[n++] = c; }
    }
  }
  return corners.subarray(0, n);
}

function grid_surface(heights, { size: [width, height], pitch_nm, origin_nm, middle_nm }) {
  const half_x = (width - 1) / 2, half_y = (height - 1) / 2;
  const positions = new Float32Array(3 * width * height);
  for (let y = 0, i = 0; y < height; ++y) {
    for (let x = 0; x < width; ++x, ++i) {
      positions[3 * i] = (x - half_x) * pitch_nm[0];
      positions[3 * i + 1] = (y - half_y) * pitch_nm[1];
      positions[3 * i + 2] = heights[i] === heights[i] ? heights[i] : 0;
    }
  }
  return {
    positions, corners: triangles_of_grid(width, height, heights),
    middle: [origin_nm[0] + half_x * pitch_nm[0], origin_nm[1] + half_y * pitch_nm[1], middle_nm],
    shape: `${width} × ${height} samples of ${pitch_nm[0] === pitch_nm[1] ? '' : `${+pitch_nm[0].toPrecision(4)} × `}` +
      `${+pitch_nm[1].toPrecision(4)} nm`,
  };
}

function mesh_surface(planes, corners, middle_nm) {
  const count = planes.length / 3;
  const positions = new Float32Array(planes.length);
  for (let i = 0; i < count; ++i) {
    for (let axis = 0; axis < 3; ++axis) positions[3 * i + axis] = planes[axis * count + i];
  }
  return { positions, corners, middle: middle_nm, shape: `${(corners.length / 3).toLocaleString('en')} triangles` };
}

function box_of(surface) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (const corner of surface.corners) {
    for (let axis = 0; axis < 3; ++axis) {
      const value = surface.positions[3 * corner + axis];
      if (value < low[axis]) low[axis] = value;
      if (value > high[axis]) high[axis] = value;
    }
  }
  for (let axis = 0; axis < 3; ++axis) {
    low[axis] += surface.middle[axis];
    high[axis] += surface.middle[axis];
  }
  return { low, high };
}

async function read_surface(told) {
  const surface = told.kind === 'grid'
    ? grid_surface(await numbers_of(told.heights), told)
    : mesh_surface(await numbers_of(told.positions), await numbers_of(told.corners), told.middle_nm);
  surface.name = told.name;
  surface.metadata = told.metadata;
  surface.box = box_of(surface);
  const heights = new Float32Array(surface.positions.length / 3);
  for (let i = 0; i < heights.length; ++i) heights[i] = surface.positions[3 * i + 2];
  surface.scalars = [{ name: 'height', unit: 'nm', values: heights, offset: surface.middle[2] }];
  for (const scalar of told.scalars) {
    surface.scalars.push({ name: scalar.name === 'height' ? 'height (file)' : scalar.name, unit: scalar.unit,
                           values: await numbers_of(scalar.values), offset: 0 });
  }
  return surface;
}

async function read_image(told) {
  const image = { ...told, channels: [] };
  for (const channel of told.channels) {
    const element = document.getElementById(`data${channel.data}`);
    const picture = new Image();
    picture.src = `data:image/png;base64,${element.textContent}`;
    element.remove();
    await picture.decode();
    image.channels.push({ ...channel, picture });
  }
  return image;
}

export async function read_scene() {
  const told = JSON.parse(document.getElementById('scene').textContent);
  if (typeof DecompressionStream === 'undefined') {
    throw new Error('this browser is too old for the page. Use Chrome 90, Firefox 113, Safari 16.4 or newer');
  }
  const scene = { ...told, surfaces: [], images: [] };
  for (const surface of told.surfaces) scene.surfaces.push(await read_surface(surface));
  for (const image of told.images) scene.images.push(await read_image(image));
  return scene;
}
