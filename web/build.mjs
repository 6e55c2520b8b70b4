// SPDX-License-Identifier: GPL-3.0-or-later
// Bundles the viewer into one page and that into C++:
//   node build.mjs PACKAGES OUTPUT.cpp [OUTPUT.html]
// PACKAGES is the folder that holds node_modules. The page has no reference to anything outside itself.
import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const [packages, output, page] = process.argv.slice(2);
if (!output) throw new Error('usage: node build.mjs PACKAGES OUTPUT.cpp [OUTPUT.html]');
const here = dirname(fileURLToPath(import.meta.url));
const modules = resolve(packages, 'node_modules');
const esbuild = createRequire(join(modules, 'x.js'))('esbuild');

const options = {
  bundle: true, minify: true, write: false, target: ['chrome90', 'firefox113', 'safari16.4'],
  nodePaths: [modules], legalComments: 'none', charset: 'utf8', logLevel: 'warning',
};
const text = async (entry, more) =>
  (await esbuild.build({ ...options, ...more, entryPoints: [join(here, 'src', entry)] })).outputFiles[0].text.trim();
const script = await text('main.js', { format: 'iife' });
const style = await text('style.css', {});

// "</script" in a script, or "<!--", would end it early.
const safe_script = script.replace(/<\/(script)/gi, '<\\/$1').replace(/<!--/g, '<\\!--');
const licence = readFileSync(join(modules, 'three', 'LICENSE'), 'utf8').trim();
const html = readFileSync(join(here, 'src', 'page.html'), 'utf8')
  .replace('/*style*/', () => style)
  .replace('/*licence of three.js*/', () => licence)
  .replace('/*script*/', () => safe_script);
if (page) writeFileSync(page, html);

// Compilers take literals of 64 KiB for certain; concatenated they would be one.
const bytes = Buffer.from(html, 'utf8');
const pieces = [];
for (let i = 0; i < bytes.length; i += 8192) {
  pieces.push([...bytes.subarray(i, i + 8192)].join(','));
}
writeFileSync(output, `// SPDX-License-Identifier: GPL-3.0-or-later
// Made from web/ by web/build.mjs.
#include "web/web_page_template.h"

namespace surf::io {
namespace {

constexpr unsigned char page[] = {
${pieces.join(',\n')}};

}  // namespace

std::string_view web_page_template() { return {reinterpret_cast<const char*>(page), sizeof page}; }

}  // namespace surf::io
`);
