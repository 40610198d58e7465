// Bundles each page into one HTML file that needs no network: node build.mjs OUTPUT_DIRECTORY
import { build } from 'esbuild';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const output = process.argv[2];
if (!output) {
  console.error('build.mjs: name the output directory');
  process.exit(2);
}

// What the licences of bundled code ask for: their notices, in full, in every page. A comment must hold no "--".
const notice = readFileSync(join(here, 'node_modules/three/LICENSE'), 'utf8').trim().replaceAll('--', '- -');

async function page(name) {
  const folder = join(here, name);
  const bundle = await build({
    entryPoints: [join(folder, 'main.js')], bundle: true, minify: true, format: 'iife', write: false,
    target: 'es2022', legalComments: 'inline', logLevel: 'warning',
  });
  // Functions as replacements: a string would have its "$" read as patterns.
  const html = readFileSync(join(folder, 'page.html'), 'utf8')
    .replace(/^<!doctype html>\n?/i, (begin) => `${begin}<!--\nThis page contains three.js:\n\n${notice}\n-->\n`)
    .replace('/*STYLE*/', () => readFileSync(join(folder, 'style.css'), 'utf8'))
    .replace('/*SCRIPT*/', () => bundle.outputFiles[0].text);
  mkdirSync(output, { recursive: true });
  writeFileSync(join(output, `${name}.html`), html);
}

for (const name of ['report', 'replay']) await page(name);
