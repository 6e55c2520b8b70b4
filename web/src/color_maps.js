// SPDX-License-Identifier: GPL-3.0-or-later
// Perceptually uniform colour maps as 33 colours each: viridis, cividis and inferno (of Matplotlib, CC0), and
// the diverging one of K. Moreland (2009).

const anchors = {
  viridis: '440154470d6048186a482374472d7b4537814240863e49893b528b375b8d33638d2f6b8e2c728e297a8e26828e23898e21918c1f988b1fa08822a78528ae8032b67a3fbc734ec36b5ec96270cf5784d44b98d83eaddc30c2df23d8e219ece51bfde725',
  cividis: '00224e00285b002e6a0533711a386f273e6e32436d3b496c434e6c4b546c535a6d5a5f6e61656f686a716f70737676767d7c788482798c8878938e789b9476a39a74aba072b4a76fbcae6cc4b468cdbb63d5c25edec958e7d150f0d846f9e03afee838',
  inferno: '0000040403120b0724150b37210c4a2f0a5b3d09654a0c6b57106e64156e71196e7d1e6d8a226a972766a32c61b0315bbc3754c73e4cd24644db503be45a31eb6628f1731df68013f98e09fb9d07fcac11fbbc21f9cb35f5db4cf2ea69f3f68afcffa4',
  grey: '000000ffffff',
  'blue–red': '3b4cc0445acc4e68d85875e16282ea6c8ff1779af782a6fb8db0fe98b9ffa3c2feaec9fcb9d0f9c3d5f4ccd9edd5dbe5dddcdce5d8d1ecd3c5f1ccb8f5c4acf7ba9ff7b093f6a586f4987af08b6eeb7d62e46e56dd5f4bd44e41ca3b37be242eb40426',
};
export const color_map_names = Object.keys(anchors);
export const diverging = 'blue–red';

/** 256 colours, four bytes each. */
export function color_table(name, reversed = false) {
  const text = anchors[name];
  const last = text.length / 6 - 1;
  const channel = (anchor, c) => parseInt(text.slice(6 * anchor + 2 * c, 6 * anchor + 2 * c + 2), 16);
  const table = new Uint8Array(4 * 256);
  for (let i = 0; i < 256; ++i) {
    const place = ((reversed ? 255 - i : i) / 255) * last;
    const before = Math.min(Math.floor(place), last - 1);
    for (let c = 0; c < 3; ++c) {
      const a = channel(before, c), b = channel(before + 1, c);
      table[4 * i + c] = Math.round(a + (b - a) * (place - before));
    }
    table[4 * i + 3] = 255;
  }
  return table;
}

/** Values at two shares of all known ones, and the extremes. */
export function value_range(scalars, low_share = 0.002, high_share = 0.998) {
  let least = Infinity, most = -Infinity, count = 0;
  for (const { values, offset } of scalars) {
    for (const value of values) {
      if (value !== value) continue;
      ++count;
      if (value + offset < least) least = value + offset;
      if (value + offset > most) most = value + offset;
    }
  }
  if (count === 0) return null;
  if (!(most > least)) return { low: least, high: most, least, most };
  const bins = new Uint32Array(4096);
  const scale = bins.length / (most - least);
  for (const { values, offset } of scalars) {
    for (const value of values) {
      if (value === value) ++bins[Math.min(bins.length - 1, Math.floor((value + offset - least) * scale))];
    }
  }
  const at = (share) => {
    let rank = share * count, bin = 0;
    while (bin < bins.length - 1 && rank >= bins[bin]) rank -= bins[bin++];
    return bin;
  };
  const low = least + at(low_share) / scale, high = least + (at(high_share) + 1) / scale;
  return { low, high: Math.min(high, most), least, most };
}

/** Whether zero lies well inside: then a diverging map about zero shows the sign. */
export const is_signed = ({ low, high }) => low < 0 && high > 0 && Math.min(-low, high) > 0.2 * Math.max(-low, high);
