// The run whose page is tested: its payload, its programs, and what motion.csv says of them.
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join } from 'node:path';
import { pageAndPictures } from './browser.mjs';
import { arrayOf, readCsv, readPayload, withPayload } from './payload.mjs';

export const { file, pictures } = pageAndPictures('page_test.mjs REPORT.html');

export const html = readFileSync(file, 'utf8');
export const payload = readPayload(html);
export const { header } = payload;
export const axes = [...header.machine.mandrel_chain, ...header.machine.eye_chain];
export const scratch = mkdtempSync(join(tmpdir(), 'meshwind-page-'));

/** All programs with their place on the common clock and what motion.csv says of them. */
export const programs = [];
header.layers.forEach((layer, l) => {
    layer.fibres.forEach((fibre, f) => {
        const suffix = `${l ? `-layer-${l + 1}` : ''}${f ? `-${f + 1}` : ''}`;
        const time = arrayOf(payload, `${fibre.prefix}time_s`);
        const rows = readCsv(readFileSync(join(dirname(file), `motion${suffix}.csv`), 'utf8'));
        // The page's clock is the controller's, the table's that of the program's words.
        if (rows.length === time.length) rows.forEach((row, k) => { row.time_s = time[k]; });
        const start = programs.length ? programs[programs.length - 1].end : 0;
        programs.push({
            fibre,
            start,
            end: start + time[time.length - 1],
            time,
            line: arrayOf(payload, `${fibre.prefix}line`),
            rows,
        });
    });
});
export const duration = programs[programs.length - 1].end;

/** `count` blocks of a program, spread over it, and its first and last one. */
export function someBlocks(program, count) {
    const last = program.rows.length - 1;
    return Array.from({ length: count }, (_, i) => Math.round((i * last) / (count - 1)));
}

/** A page with other data, in the scratch folder. */
export function variant(name, change) {
    const copy = readPayload(html);
    change(copy);
    const path = join(scratch, name);
    writeFileSync(path, withPayload(html, copy));
    return path;
}

/** Moves the slider as a hand does. */
export function slide(page, time) {
    return page.evaluate((t) => {
        const slider = document.getElementById('slider');
        slider.value = String(t);
        slider.dispatchEvent(new Event('input', { bubbles: true }));
    }, time);
}

export function picture(page, name) {
    return pictures ? page.screenshot({ path: join(pictures, `${name}.png`) }) : undefined;
}

export const tests = [];
export const test = (name, body) => tests.push({ name, body });
export const tidy = () => rmSync(scratch, { recursive: true, force: true });
