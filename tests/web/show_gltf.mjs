// SPDX-License-Identifier: GPL-3.0-or-later
// Shows every glTF file of a folder with three.js in headless Chromium, through the file's own camera. Usage:
//   node show_gltf.mjs PACKAGES FOLDER [PICTURES]
// PACKAGES holds node_modules; ends with 77 where these or a browser are missing. Beside each file NAME lies NAME.box.json: the box [[x, y, z], [x, y, z]] that it must have, in metres. Checks
// the box, that the camera sees all corners of the surfaces, and that pixels are lit. PICTURES: a folder for
// what was seen.
import { createServer } from 'node:http';
import { mkdirSync, readFileSync, readdirSync } from 'node:fs';
import { join, normalize, resolve } from 'node:path';
import { find_browser } from './puppeteer.mjs';

const [packages, folder, pictures] = process.argv.slice(2);
const { browser_path, puppeteer } = find_browser(packages, 'three');

const page = `<!DOCTYPE html><meta charset="utf-8"><body style="margin:0;background:#000">
<script type="importmap">{"imports": {"three": "/three/build/three.module.js", "three/": "/three/"}}</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/examples/jsm/loaders/GLTFLoader.js';
const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
renderer.setSize(400, 300);
document.body.append(renderer.domElement);

window.show = async (url) => {
  const gltf = await new GLTFLoader().loadAsync(url);
  const scene = new THREE.Scene();
  scene.add(gltf.scene, new THREE.HemisphereLight(0xffffff, 0x888888, 3));
  scene.updateMatrixWorld(true);
  const box = new THREE.Box3().setFromObject(gltf.scene, true);
  const camera = gltf.cameras[0];
  camera.aspect = 4 / 3;
  camera.updateProjectionMatrix();
  camera.updateMatrixWorld(true);
  let outmost = 0;   // 1 is the edge of the picture
  const attributes = new Set();
  let lines = 0;
  gltf.scene.traverse((node) => {
    if (node.isLine) ++lines;
    if (!node.isMesh) return;
    const position = node.geometry.getAttribute('position');
    Object.keys(node.geometry.attributes).forEach((name) => attributes.add(name));
    for (let i = 0; i < position.count; ++i) {
      const p = new THREE.Vector3().fromBufferAttribute(position, i).applyMatrix4(node.matrixWorld).project(camera);
      outmost = Math.max(outmost, Math.abs(p.x), Math.abs(p.y), p.z > 1 || p.z < -1 ? 9 : 0);
    }
  });
  renderer.render(scene, camera);
  const gl = renderer.getContext();
  const pixels = new Uint8Array(400 * 300 * 4);
  gl.readPixels(0, 0, 400, 300, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let lit = 0, colored = 0;   // surfaces here are nearly grey, tracks are not
  for (let i = 0; i < pixels.length; i += 4) {
    const [r, g, b] = pixels.subarray(i, i + 3);
    if (r + g + b > 30) ++lit;
    if (Math.max(r, g, b) - Math.min(r, g, b) > 90) ++colored;
  }
  return { box: [box.min.toArray(), box.max.toArray()], outmost, lit: lit / (400 * 300), colored, lines,
           attributes: [...attributes].sort(), own: gltf.asset.extras.semsurf };
};
window.ready = true;
</script>`;

function content(url) {
  const path = normalize(decodeURIComponent(new URL(url, 'http://x').pathname));
  if (path === '/') return page;
  return readFileSync(path.startsWith('/three/') ? join(packages, 'node_modules', path) : join(folder, path));
}

function serve() {
  const server = createServer((request, response) => {
    try {
      const body = content(request.url);
      response.setHeader('Content-Type', request.url.endsWith('.js') ? 'text/javascript'
        : request.url === '/' ? 'text/html' : 'application/octet-stream');
      response.end(body);
    } catch {
      response.statusCode = 404;
      response.end();
    }
  });
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve(server)));
}

function faults(seen, expected) {
  const size = Math.max(...expected[1].map((high, i) => high - expected[0][i]));
  const found = [];
  for (const end of [0, 1]) {
    for (const axis of [0, 1, 2]) {
      // three.js keeps matrices in double, positions in float32.
      const shift = Math.abs(seen.box[end][axis] - expected[end][axis]);
      if (!(shift <= 1e-6 * size + 1e-12 * Math.abs(expected[end][axis]))) {
        found.push(`the box ${JSON.stringify(seen.box)} should be ${JSON.stringify(expected)}`);
      }
    }
  }
  if (!(seen.outmost <= 1)) found.push(`the camera does not see all: ${seen.outmost}`);
  if (!(seen.outmost >= 0.6)) found.push(`the camera is too far away: ${seen.outmost}`);
  if (!(seen.lit >= 0.01)) found.push(`only ${seen.lit} of the picture is lit`);
  if (seen.lines > 0 && seen.colored < 20) found.push(`only ${seen.colored} pixels show tracks`);
  if (!(seen.own?.magnification > 0)) found.push('the magnification is missing');
  return [...new Set(found)];
}

const server = await serve();
const browser = await puppeteer.launch({
  executablePath: browser_path,
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
let good = true;
try {
  const tab = await browser.newPage();
  tab.on('pageerror', (error) => console.log(`  in the page: ${error.message}`));
  await tab.goto(`http://127.0.0.1:${server.address().port}/`);
  await tab.waitForFunction('window.ready', { timeout: 60000 });
  const names = readdirSync(folder).filter((name) => /\.(glb|gltf)$/.test(name)).sort();
  if (names.length === 0) throw new Error('there are no files to show');
  if (pictures) mkdirSync(pictures, { recursive: true });
  for (const name of names) {
    const seen = await tab.evaluate((url) => window.show(url), `/${encodeURIComponent(name)}`);
    if (pictures) await tab.screenshot({ path: join(pictures, `${name}.png`) });
    const found = faults(seen, JSON.parse(readFileSync(join(folder, `${name}.box.json`))));
    good &&= found.length === 0;
    console.log(`${name}: ${(100 * seen.lit).toFixed(1)} % lit, ${seen.attributes.join(' ')}`);
    found.forEach((fault) => console.log(`  ${fault}`));
  }
} finally {
  await browser.close();
  server.close();
}
process.exit(good ? 0 : 1);
