// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures beside the surfaces, with their own scale bars and the section's line; a click shows one large.
import { h, icon } from './dom.js';
import { number, round_down, round_length, with_unit } from './format.js';

/** Where a place in nm is on a picture drawn `width` pixels wide. */
const to_pixel = (image, width, [x, y]) => {
  const scale = width / image.size[0];
  return [((x - image.origin_nm[0]) / image.pitch_nm[0] + 0.5) * scale,
          (image.size[1] - 0.5 - (y - image.origin_nm[1]) / image.pitch_nm[1]) * scale];
};

export function paint_image(canvas, image, channel, section, width) {
  const shape = image.pitch_nm ? image.size[1] * image.pitch_nm[1] / (image.size[0] * image.pitch_nm[0])
                               : image.size[1] / image.size[0];
  const ratio = Math.min(2, devicePixelRatio), height = width * shape;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  canvas.style.width = `${width}px`;
  const pen = canvas.getContext('2d');
  pen.scale(ratio, ratio);
  pen.imageSmoothingQuality = 'high';
  pen.imageSmoothingEnabled = width < 3 * image.size[0];
  pen.drawImage(image.channels[channel].picture, 0, 0, width, height);
  if (!image.pitch_nm) return;
  const outlined = (path, color, size) => {
    for (const [style, line_width] of [['rgba(0,0,0,.65)', size + 2.5], [color, size]]) {
      pen.strokeStyle = style;
      pen.lineWidth = line_width;
      pen.beginPath();
      path();
      pen.stroke();
    }
  };
  if (section) {
    const square = (point) => {
      const [x, y] = to_pixel(image, width, point);
      return [x, y * shape * image.size[0] / image.size[1]];
    };
    outlined(() => { pen.moveTo(...square(section.a)); pen.lineTo(...square(section.b)); }, '#fff', 1.5);
  }
  const per_nm = width / (image.size[0] * image.pitch_nm[0]);
  const length = round_down(0.33 * width / per_nm);
  outlined(() => { pen.moveTo(12, height - 12); pen.lineTo(12 + length * per_nm, height - 12); }, '#fff', 2.5);
  pen.font = '600 12px system-ui, sans-serif';
  pen.textAlign = 'left';
  pen.lineWidth = 3;
  pen.strokeStyle = 'rgba(0,0,0,.65)';
  pen.strokeText(round_length(length), 12, height - 19);
  pen.fillStyle = '#fff';
  pen.fillText(round_length(length), 12, height - 19);
}

/** The value shown at a pixel of the picture, to 1/255 of its range. */
function value_of(image, channel, column, row) {
  const { picture, low, high } = image.channels[channel];
  const canvas = new OffscreenCanvas(1, 1);
  const pen = canvas.getContext('2d', { willReadFrequently: true });
  pen.drawImage(picture, -column, -row);
  return low + pen.getImageData(0, 0, 1, 1).data[0] / 255 * (high - low);
}

function open_large(image, start, state) {
  let channel = start;
  const canvas = h('canvas', { role: 'img', 'aria-label': image.name });
  const told = h('output', { class: 'readout' });
  const dialog = h('dialog', { class: 'picture', 'aria-label': image.name, onclose: () => dialog.remove() });
  const paint = () => {
    const shape = image.size[1] / image.size[0];
    const width = Math.max(120, Math.min(innerWidth - 60, (innerHeight - 130) / shape));
    paint_image(canvas, image, channel, state.section, width);
  };
  canvas.addEventListener('pointermove', (event) => {
    const box = canvas.getBoundingClientRect();
    const column = Math.floor((event.clientX - box.left) / box.width * image.size[0]);
    const row = Math.floor((event.clientY - box.top) / box.height * image.size[1]);
    const up = image.size[1] - 1 - row;
    const { unit, name, low, high } = image.channels[channel];
    const place = image.pitch_nm
      ? `x ${number(image.origin_nm[0] + column * image.pitch_nm[0], image.pitch_nm[0] / 10)}   ` +
        `y ${number(image.origin_nm[1] + up * image.pitch_nm[1], image.pitch_nm[1] / 10)} nm`
      : `column ${column}   row ${row}`;
    told.textContent = `${place}   ${with_unit(`${name} ≈ ${number(value_of(image, channel, column, row), (high - low) / 255)}`, unit)}`;
  });
  const pick = image.channels.length > 1 &&
    h('select', { 'aria-label': 'Channel', onchange: (event) => { channel = Number(event.target.value); paint(); } },
      image.channels.map(({ name }, i) => h('option', { value: String(i), selected: i === channel }, name)));
  dialog.append(h('div', { class: 'bar' }, h('h2', {}, image.name), ...(pick ? [pick] : []), h('span', { class: 'space' }),
    h('button', { class: 'plain', title: 'Close', 'aria-label': 'Close', onclick: () => dialog.close() }, icon('close'))),
    canvas, told);
  document.body.append(dialog);
  dialog.showModal();
  paint();
}

export function make_images(scene, state) {
  const cards = scene.images.map((image, index) => {
    const canvas = h('canvas', { role: 'img', 'aria-label': image.name });
    let channel = state.drape?.image === index ? state.drape.channel : 0;
    const paint = () => canvas.isConnected && paint_image(canvas, image, channel, state.section, canvas.parentElement.clientWidth);
    const lies_over = image.pitch_nm && scene.surfaces.some(({ box }) => [0, 1].every((axis) =>
      box.low[axis] < image.origin_nm[axis] + image.size[axis] * image.pitch_nm[axis] && box.high[axis] > image.origin_nm[axis]));
    const laid = h('input', { type: 'checkbox', class: 'switch', checked: state.drape?.image === index, onchange: () =>
      state.set({ drape: laid.checked ? { image: index, channel } : null, drape_share: 1 }) });
    state.on(['drape'], () => { laid.checked = state.drape?.image === index; });
    state.on(['section'], paint);
    const chosen = image.channels.length > 1
      ? h('select', { 'aria-label': `Channel of ${image.name}`, onchange: (event) => {
          channel = Number(event.target.value);
          paint();
          if (laid.checked) state.set({ drape: { image: index, channel } });
        } }, image.channels.map(({ name }, i) => h('option', { value: String(i), selected: i === channel }, name)))
      : h('span', { class: 'quiet' }, image.channels[0]?.name === 'L' ? '' : image.channels[0]?.name);
    const frame = h('div', { class: 'frame' }, h('button', { class: 'picture-button', title: 'Show large',
      'aria-label': `Show ${image.name} large`, onclick: () => open_large(image, channel, state) }, canvas));
    new ResizeObserver(paint).observe(frame);
    return h('figure', {}, frame, h('figcaption', {}, h('span', { class: 'name', title: image.name }, image.name), chosen,
      lies_over ? h('label', { class: 'line' }, laid, 'laid on') : image.pitch_nm ? null : h('span', { class: 'quiet' }, 'scale not known')));
  });
  return cards;
}
