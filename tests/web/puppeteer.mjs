// SPDX-License-Identifier: GPL-3.0-or-later
// The browser that tests drive, and what drives it.
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, resolve } from 'node:path';

// PACKAGES holds node_modules, of which those named are needed. Exits with 77 where one of them or a browser is missing.
export function find_browser(packages, ...needed) {
  const skip = (reason) => { console.log(`skipped: ${reason}`); process.exit(77); };
  const browser_path = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome']
    .find((path) => path && existsSync(path));
  if (!browser_path) skip('no Chromium (apt-get install chromium)');
  for (const name of ['puppeteer-core', ...needed])
    if (!existsSync(join(packages, 'node_modules', name))) skip(`no ${name} (npm could not fetch it)`);
  return { browser_path, puppeteer: createRequire(resolve(packages, 'node_modules', 'x.js'))('puppeteer-core') };
}
