// SPDX-License-Identifier: GPL-3.0-or-later
// Runs Khronos' glTF validator over files (.glb, .gltf) or folders of them. Usage:
//   node validate_gltf.mjs PACKAGES PATH...
// PACKAGES holds node_modules. Says a line per file and ends with 1 if one has an error or a warning, or if there
// is no file; with 77 where the validator is not installed.
import { existsSync, readFileSync, readdirSync, statSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';

const [packages, ...paths] = process.argv.slice(2);
if (!existsSync(join(packages, 'node_modules', 'gltf-validator'))) {
  console.log('skipped: no gltf-validator (./check --all installs it)');
  process.exit(77);
}
const validator = createRequire(resolve(packages, 'node_modules', 'x.js'))('gltf-validator');

function filesOf(path) {
  if (!statSync(path).isDirectory()) return [path];
  return readdirSync(path).filter((name) => /\.(glb|gltf)$/.test(name)).sort().map((name) => join(path, name));
}

async function validate(path) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {
    uri: path,
    maxIssues: 20,
    externalResourceFunction: async (uri) =>
      new Uint8Array(readFileSync(join(dirname(path), decodeURIComponent(uri)))),
  });
  const { numErrors, numWarnings, numInfos, messages } = report.issues;
  console.log(`${path}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} notes`);
  for (const m of messages) console.log(`  ${m.code} at ${m.pointer ?? m.offset ?? '?'}: ${m.message}`);
  return numErrors + numWarnings === 0;
}

const files = paths.flatMap(filesOf);
let good = files.length > 0;
if (!good) console.log('there are no files to validate');
for (const file of files) good = (await validate(file)) && good;
process.exit(good ? 0 : 1);
