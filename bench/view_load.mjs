// SPDX-License-Identifier: GPL-3.0-or-later
// How long a browser takes to show a surface of 512 x 512, drawn in software:
//   node bench/view_load.mjs build/tests/web build/bin/semsurf [SIZE]
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const [packages, semsurf, size = '512'] = process.argv.slice(2);
const puppeteer = createRequire(resolve(packages, 'node_modules', 'x.js'))('puppeteer-core');
const folder = mkdtempSync(join(tmpdir(), 'semsurf-view-'));
let browser;
try {
  let seed = 1;   // noise of 0.1 nm on waves
  const noise = () => ((seed = (seed * 48271) % 2147483647) / 2147483647 - 0.5) / 5;
  const n = Number(size);
  const rows = Array.from({ length: n }, (_, y) => Array.from({ length: n }, (_, x) =>
    (10 * Math.sin(x / 30) * Math.cos(y / 40) + noise()).toFixed(4)).join(' '));
  writeFileSync(join(folder, 'scan.txt'), rows.join('\n'));
  execFileSync(semsurf, ['view', '-q', '--pixel-size', '2nm', 'scan.txt', '-o', 'page.html'], { cwd: folder });
  console.log(`page ${(statSync(join(folder, 'page.html')).size / 1e6).toFixed(2)} MB`);
  browser = await puppeteer.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });
  for (let run = 0; run < 5; ++run) {
    const page = await browser.newPage();
    await page.setViewport({ width: 1440, height: 900 });
    await page.goto(pathToFileURL(join(folder, 'page.html')).href);
    await page.waitForFunction('window.semsurf?.ready_ms', { timeout: 120000 });
    console.log(`shown after ${Math.round(await page.evaluate('window.semsurf.ready_ms'))} ms`);
    await page.close();
  }
} finally {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
}
