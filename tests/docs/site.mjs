// SPDX-License-Identifier: GPL-3.0-or-later
// Opens the manual's web site in a real browser:
//   node site.mjs PACKAGES SITE [PICTURES]
// PACKAGES holds node_modules; SITE is the folder that site/build.py wrote; pictures of pages, wide and narrow, light and dark, go
// to the folder PICTURES. Nothing may be asked for outside SITE, nothing may fail, no page is wider than the window, the search
// finds a page, and the interactive page draws. Exits with 77 where no browser is installed.
import assert from 'node:assert/strict';
import { createReadStream, existsSync, mkdirSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, normalize } from 'node:path';
import { find_browser } from '../web/puppeteer.mjs';

const [packages, site, pictures] = process.argv.slice(2);
const { browser_path, puppeteer } = find_browser(packages);

const types = { '.html': 'text/html', '.css': 'text/css', '.js': 'text/javascript', '.json': 'application/json', '.svg': 'image/svg+xml',
  '.png': 'image/png' };
const server = createServer((request, answer) => {
  const path = join(site, normalize(decodeURIComponent(new URL(request.url, 'http://localhost').pathname)));
  if (!existsSync(path) || !statSync(path).isFile()) return answer.writeHead(404).end();
  answer.writeHead(200, { 'content-type': types[extname(path)] ?? 'application/octet-stream' });
  createReadStream(path).pipe(answer);
});
await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
const home = `http://127.0.0.1:${server.address().port}/`;

let browser, asked = 0;
const outside = [], failed = [];

async function open(path, { width = 1400, theme = 'light' } = {}) {
  const context = await browser.createBrowserContext();   // with no memory of a colour scheme
  const page = await context.newPage();
  page.on('request', (request) => {
    if (/^(data|blob):/.test(request.url())) return;
    ++asked;
    if (!request.url().startsWith(home)) outside.push(`${path}: ${request.url()}`);
  });
  page.on('response', (answer) => {
    if (answer.status() >= 400 && !answer.url().endsWith('/favicon.ico')) failed.push(`${path}: ${answer.status()} ${answer.url()}`);
  });
  page.on('pageerror', (error) => failed.push(`${path}: ${error.message}`));
  await page.setViewport({ width, height: 900, isMobile: width < 600, hasTouch: width < 600 });
  await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: theme }]);
  await page.goto(home + path, { waitUntil: 'load', timeout: 300000 });
  return page;
}

const pages = ['index.html', 'contents.html', 'tutorials/first_image.html', 'tutorials/reconstruction.html', 'how-to/paraview.html',
  'how-to/view.html', 'reference/commands.html', 'reference/scene_files.html', 'explanation/reconstruction.html',
  'explanation/materials.html', 'explanation/limits.html', 'explanation/compare.html', 'notebooks/first_image.html',
  'gallery/index.html', 'development/architecture.html', 'source/samples/paraview_pipeline.py.html', 'changelog.html',
  'cpp/index.html'];

const looks = [[1400, 'light'], [420, 'dark'], ...(pictures ? [[1400, 'dark'], [420, 'light']] : [])];

async function test_pages() {
  for (const path of pages) {
    for (const [width, theme] of looks) {
      const page = await open(path, { width, theme });
      const wide = await page.evaluate(() => document.documentElement.scrollWidth);
      if (!path.startsWith('cpp/')) assert.ok(wide <= width, `${path} is ${wide} wide in a window of ${width}`);
      if (!path.startsWith('cpp/')) {
        assert.equal(await page.evaluate(() => document.body.dataset.mdColorScheme), theme === 'dark' ? 'slate' : 'default', path);
      }
      const broken = await page.evaluate(() => [...document.images].filter((image) => image.complete && !image.naturalWidth)
        .map((image) => image.src));
      assert.deepEqual(broken, [], `pictures of ${path}`);
      if (pictures) await page.screenshot({ path: join(pictures, `${path.replaceAll('/', '_')}_${width}_${theme}.png`) });
      await page.browserContext().close();
    }
  }
}

async function test_search() {
  const page = await open('index.html');
  await page.click('.md-search__input');
  await page.type('.md-search__input', 'Tukey');
  await page.waitForSelector('.md-search-result__link', { timeout: 300000 });
  const found = await page.$$eval('.md-search-result__link', (links) => links.map((link) => link.href));
  assert.ok(found.some((link) => link.includes('explanation/compare.html')), `the search finds ${found}`);
  if (pictures) await page.screenshot({ path: join(pictures, 'search.png') });
  await page.browserContext().close();
}

async function test_dark_switch() {
  const page = await open('index.html');
  const scheme = () => page.evaluate(() => document.body.dataset.mdColorScheme);
  assert.equal(await scheme(), 'default');
  await page.evaluate(() => document.querySelector('label[for="__palette_2"]').click());
  assert.equal(await scheme(), 'slate');
  await page.browserContext().close();
}

async function test_interactive_page() {
  const page = await open('tutorials/first_image.html');
  const frame = await page.$('iframe.viewer');
  if (!frame) { console.log('semsurf was built without the viewer: no interactive pages'); return page.browserContext().close(); }
  await frame.evaluate((element) => element.scrollIntoView());
  const inside = await frame.contentFrame();
  await inside.waitForFunction('document.documentElement.dataset.ready === "true"', { timeout: 300000 });
  if (pictures) await page.screenshot({ path: join(pictures, 'interactive.png') });
  await page.browserContext().close();
}

try {
  if (pictures) mkdirSync(pictures, { recursive: true });
  browser = await puppeteer.launch({
    executablePath: browser_path, protocolTimeout: 900000,
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
  for (const test of [test_pages, test_search, test_dark_switch, test_interactive_page]) {
    await test();
    console.log(`${test.name.replaceAll('_', ' ')}: passed`);
  }
  assert.deepEqual(failed, [], 'requests and scripts that failed');
  assert.deepEqual(outside, [], 'requests that leave the site');
  console.log(`${asked} requests, none outside the site`);
} finally {
  await browser?.close();
  server.close();
}
