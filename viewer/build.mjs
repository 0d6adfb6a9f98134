// Bundles a page into one HTML file: node build.mjs OUT.html [part|strength]
// The page of report.html, that of a part, or that of a wall's strength, which looks like a part's.
// The program puts its data in the place of <!--MESHWIND-DATA-->.
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build, transform } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const [output, which] = process.argv.slice(2);
if (!output || process.argv.length > 4 || (which && which !== 'part' && which !== 'strength')) {
    console.error('usage: node build.mjs OUT.html [part|strength]');
    process.exit(2);
}
const source = join(here, 'src', which ?? '');
// Frame and styles: those of a part serve for all that is no run.
const frame = join(here, 'src', which ? 'part' : '');

const marker = '<!--MESHWIND-DATA-->';
const bundle = await build({
    entryPoints: [join(source, 'main.ts')],
    bundle: true,
    minify: true,
    write: false,
    format: 'iife',
    target: ['es2021'],
    charset: 'ascii',
    legalComments: 'none',
});
const sheets = [join(here, 'src', 'style.css'), ...(which ? [join(frame, 'style.css')] : [])];
const style = await transform(sheets.map((sheet) => readFileSync(sheet, 'utf8')).join('\n'), {
    loader: 'css',
    minify: true,
});
const licence = readFileSync(join(here, 'node_modules', 'three', 'LICENSE'), 'utf8').trim();

// A closing tag or the marker inside a string of the bundle would end the script, or be taken for
// the place of the data.
const script = bundle.outputFiles[0].text
    .replace(/<\/(script)/gi, '<\\/$1')
    .replace(/<!--/g, '\\x3C!--')
    .trim();
const page = readFileSync(join(frame, 'index.html'), 'utf8')
    .replace('/*STYLE*/', () => style.code.trim())
    .replace('/*SCRIPT*/', () => script)
    .replace('<!--LICENCE-->', () => `<!--\nthree.js: ${licence}\n-->`);
if (page.split(marker).length !== 2) {
    throw new Error(`the page must have ${marker} exactly once`);
}
writeFileSync(output, page);
