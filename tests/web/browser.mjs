// SPDX-License-Identifier: GPL-3.0-or-later
// Drives a page of semsurf view in a real browser:
//   node browser.mjs PACKAGES SEMSURF [PICTURES]
// PACKAGES holds node_modules; pictures of what was seen go to the folder PICTURES. Exits with 77 where no
// browser is installed.
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { execFileSync } from 'node:child_process';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { find_browser } from './puppeteer.mjs';

const [packages, semsurf, pictures] = process.argv.slice(2);
const { browser_path, puppeteer } = find_browser(packages);

// What is shown, as formulas: a slope with a bump, and the same 3 nm higher without it.
const size = 96, pitch = 2;
const first = (x, y) => 0.1 * x + 0.05 * y + 20 * Math.exp(-((x - 70) ** 2 + (y - 120) ** 2) / 1600);
const second = (x, y) => 0.1 * x + 0.05 * y + 3;
const heights = (f) => {   // rows from the top
  const rows = [];
  for (let y = size - 1; y >= 0; --y) rows.push(Array.from({ length: size }, (_, x) => f(pitch * x, pitch * y)).join(' '));
  return rows.join('\n') + '\n';
};

const folder = mkdtempSync(join(tmpdir(), 'semsurf-web-'));
let browser;

async function open(url, { width = 1440, height = 900, theme = 'light', webgl = true, phone = false } = {}) {
  const page = await browser.newPage();
  const seen = { requests: [], errors: [] };
  page.on('request', (request) => {
    if (!/^(data|blob):/.test(request.url())) seen.requests.push(request.url());
  });
  page.on('pageerror', (error) => seen.errors.push(error.message));
  page.on('console', (message) => { if (message.type() === 'error') seen.errors.push(message.text()); });
  await page.setOfflineMode(true);
  await page.setViewport({ width, height, isMobile: phone, hasTouch: phone, deviceScaleFactor: phone ? 2 : 1 });
  await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: theme }]);
  if (!webgl) {
    await page.evaluateOnNewDocument(() => {
      const given = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
        return /webgl/.test(kind) ? null : given.call(this, kind, ...more);
      };
    });
  }
  await page.goto(url);
  await page.waitForFunction('document.documentElement.dataset.ready === "true"', { timeout: 60000 });
  return { page, seen };
}

// Until nothing is drawn any more and the picture is as large as its place, which a panel that opens makes smaller.
const still = (page) => page.evaluate(() => new Promise((done) => {
  const { stage } = window.semsurf, place = document.getElementById('view');
  const frame = () => new Promise(requestAnimationFrame);
  const look = async (frames) => {
    await frame();
    await new Promise((later) => setTimeout(later, 300));
    await frame();
    const fits = stage.size[0] === place.clientWidth && stage.size[1] === place.clientHeight;
    if (fits && stage.frames === frames) done();
    else look(stage.frames);
  };
  look(-1);
}));
const project = (page, x, y, z) => page.evaluate((...p) => {
  const box = document.getElementById('view').getBoundingClientRect();
  const [px, py] = window.semsurf.stage.project(...p);
  return [px + box.left, py + box.top];
}, x, y, z);
const text_of = (page, id) => page.$eval(`#${id}`, (element) => element.textContent);
const numbers_in = (text) => [...text.replaceAll('−', '-').matchAll(/-?\d+(\.\d+)?(e-?\d+)?/g)].map((match) => Number(match[0]));
const near = (value, truth, error, what) =>
  assert.ok(Math.abs(value - truth) <= error, `${what}: ${value} is shown for ${truth}, more than ${error} off`);
const picture = async (page, name) => pictures && page.screenshot({ path: join(pictures, name) });

/** Pixels of the view that belong to the surface: saturated ones, as viridis is and the ground is not. */
const lit_pixels = (page) => page.evaluate(() => {
  const { stage } = window.semsurf;
  stage.draw();
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [stage.canvas.width, stage.canvas.height];
  const pen = copy.getContext('2d');
  pen.drawImage(stage.canvas, 0, 0);
  const { data } = pen.getImageData(0, 0, copy.width, copy.height);
  let lit = 0;
  for (let i = 0; i < data.length; i += 4) lit += data[i + 3] === 255 && Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 40;
  return lit / (data.length / 4);
});

async function read_point(page, x, y, z, what) {
  await page.mouse.move(...await project(page, x, y, z));
  await page.waitForFunction(() => !document.getElementById('readout').hidden, { timeout: 10000 });
  await new Promise((done) => setTimeout(done, 300));
  const shown = numbers_in((await text_of(page, 'readout')).replace(/^[^ ]* {3}x/, 'x'));
  near(shown[0], x, 0.005 * size * pitch, `${what}, x`);
  near(shown[1], y, 0.005 * size * pitch, `${what}, y`);
  return shown;
}

async function drag_section(page, from, to, f) {
  await page.click('#tool-section');
  await still(page);
  // A browser that is short of time may drop moves, as a hand would then drag again.
  let section = null;
  for (let tries = 0; tries < 3 && !section; ++tries) {
    const a = await project(page, ...from, f(...from)), b = await project(page, ...to, f(...to));
    await page.mouse.move(...a);
    await page.mouse.down();
    await page.mouse.move((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, { steps: 4 });
    await page.mouse.move(...b, { steps: 4 });
    await page.mouse.up();
    await still(page);
    for (let wait = 0; wait < 20 && !section; ++wait) {
      section = await page.evaluate(() => window.semsurf.state.section);
      if (!section) await new Promise((done) => setTimeout(done, 100));
    }
  }
  assert.ok(section, 'a drag draws a section');
  const pixel = await page.evaluate(() => 1 / window.semsurf.stage.pixels_per_nm());
  for (const axis of [0, 1]) {
    near(section.a[axis], from[axis], 2.5 * pixel, 'the end A');
    near(section.b[axis], to[axis], 2.5 * pixel, 'the end B');
  }
  return section;
}

/** Compares the chart's read-out with the formulas at places all along the section. */
async function check_profile(page, section, truths) {
  const length = Math.hypot(section.b[0] - section.a[0], section.b[1] - section.a[1]);
  const chart = await page.$eval('#profile svg', (svg) => { const box = svg.getBoundingClientRect(); return [box.left, box.top, box.width, box.height]; });
  let worst = 0;
  for (const share of [0.1, 0.3, 0.45, 0.6, 0.8, 0.95]) {
    await page.mouse.move(chart[0] + 62 + share * (chart[2] - 78), chart[1] + chart[3] / 2);
    await new Promise((done) => setTimeout(done, 100));
    const parts = (await text_of(page, 'profile-readout')).split('·');
    assert.equal(parts.length, 1 + truths.length, 'one height for each surface');
    const s = numbers_in(parts[0])[0];
    const [x, y] = [0, 1].map((axis) => section.a[axis] + s / length * (section.b[axis] - section.a[axis]));
    truths.forEach(([name, f, range], i) => {
      const shown = numbers_in(parts[1 + i].replace(name, '')).pop();
      worst = Math.max(worst, Math.abs(shown - f(x, y)) / range);
      near(shown, f(x, y), 0.005 * range, `the profile of ${name} at ${s} nm`);
    });
  }
  return worst;
}

async function test_page(url) {
  const { page, seen } = await open(url);
  console.log(`ready after ${Math.round(await page.evaluate(() => window.semsurf.ready_ms))} ms`);
  await still(page);
  assert.ok(await lit_pixels(page) > 0.05, 'the surface is seen');
  const shown = await read_point(page, 70, 120, first(70, 120), 'a point of the first surface');
  near(shown[2], first(70, 120), 0.1, 'its height');
  await picture(page, 'page.png');

  // The other surface, at the same camera.
  const camera_of = () => page.evaluate(() => [...window.semsurf.stage.camera.matrixWorld.elements]);
  const camera = await camera_of();
  await page.click('[data-surface="1"]');
  await still(page);
  assert.deepEqual(await page.evaluate(() => window.semsurf.state.visible), [false, true]);
  (await camera_of()).forEach((value, i) => near(value, camera[i], 1e-6 * Math.abs(camera[i]) + 1e-9, 'the camera'));
  near((await read_point(page, 70, 120, second(70, 120), 'a point of the second surface'))[2], second(70, 120), 0.1, 'its height');
  await page.keyboard.press('1');
  assert.deepEqual(await page.evaluate(() => window.semsurf.state.visible), [true, false]);

  // A section of one, then of both.
  const section = await drag_section(page, [20, 30], [150, 170], first);
  const worst = await check_profile(page, section, [['first', first, 40]]);
  await page.keyboard.press('a');
  await still(page);
  await check_profile(page, section, [['first', first, 40], ['second', second, 40]]);
  console.log(`profile within ${(100 * worst).toFixed(3)} % of the height`);
  await picture(page, 'section.png');

  // Heights ten times as high change the look, not the numbers.
  await page.evaluate(() => window.semsurf.state.set({ exaggeration: 10 }));
  await still(page);
  assert.match(await text_of(page, 'chip'), /Heights × 10/);
  await check_profile(page, section, [['first', first, 40], ['second', second, 40]]);
  await page.click('#chip');
  assert.equal(await page.evaluate(() => window.semsurf.state.exaggeration), 1);

  // The scale bar is as long as it says.
  const bar = await page.evaluate(() => ({ ...window.semsurf.overlay.scale_bar, scale: window.semsurf.stage.pixels_per_nm() }));
  near(bar.pixels, bar.nm * bar.scale, 0.5, 'the scale bar');
  await page.keyboard.press('t');
  await still(page);
  const [left, right] = [await project(page, 0, 50, 0), await project(page, 100, 50, 0)];
  near(right[0] - left[0], 100 * await page.evaluate(() => window.semsurf.stage.pixels_per_nm()), 0.5, '100 nm from above');

  const requests = seen.requests.filter((request) => request !== url);
  assert.deepEqual(requests, [], 'nothing is fetched');
  assert.deepEqual(seen.errors, []);
  await page.close();
}

async function test_phone(url) {
  const { page, seen } = await open(url, { width: 390, height: 844, theme: 'dark', phone: true });
  await still(page);
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), 'nothing is wider than the screen');
  assert.ok(await lit_pixels(page) > 0.03, 'the surface is seen');
  const at = await project(page, 70, 120, first(70, 120));
  await page.touchscreen.tap(...at);
  await page.waitForFunction(() => !document.getElementById('readout').hidden, { timeout: 10000 });
  await picture(page, 'phone.png');
  assert.deepEqual(seen.errors, []);
  await page.close();
}

async function test_without_webgl(url) {
  const { page } = await open(url, { webgl: false });
  await still(page);
  assert.match(await text_of(page, 'notice'), /shows no 3D.*hardware acceleration/);
  assert.ok(await lit_pixels(page) > 0.05, 'the surface is seen from above');
  const section = await drag_section(page, [20, 30], [150, 170], first);
  await check_profile(page, section, [['first', first, 40]]);
  await picture(page, 'flat.png');
  await page.close();
}

/** A mesh, with an image laid on: the picture's own greys are seen, not the colours of height. */
async function test_drape(url) {
  const { page, seen } = await open(url);
  await still(page);
  assert.ok(await lit_pixels(page) < 0.002, 'a grey image covers the surface');
  await page.keyboard.press('d');
  await still(page);
  assert.ok(await lit_pixels(page) > 0.05, 'D takes it off');
  await picture(page, 'drape.png');
  assert.deepEqual(seen.errors, []);
  await page.close();
}

try {
  if (pictures) mkdirSync(pictures, { recursive: true });
  writeFileSync(join(folder, 'first.txt'), heights(first));
  writeFileSync(join(folder, 'second.txt'), heights(second));
  const view = (...options) => execFileSync(semsurf, ['view', '-q', '--pixel-size', `${pitch}nm`, ...options], { cwd: folder });
  view('first.txt', 'second.txt', '-o', 'page.html');
  view('first.txt', '--drape', 'second.txt', '-o', 'drape.html');
  const html = readFileSync(join(folder, 'page.html'), 'utf8');
  assert.match(html, /three\.js authors/, 'the licence of three.js');
  browser = await puppeteer.launch({
    executablePath: browser_path,
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
  const url = (name) => pathToFileURL(join(folder, name)).href;
  for (const test of [test_page, test_phone, test_without_webgl]) {
    await test(url('page.html'));
    console.log(`${test.name.replaceAll('_', ' ')}: passed`);
  }
  await test_drape(url('drape.html'));
  console.log('test drape: passed');
} finally {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
}
