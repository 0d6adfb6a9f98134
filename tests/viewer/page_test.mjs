// What report.html shows and does, in a browser:
//   node page_test.mjs REPORT.html [SCREENSHOTS]
// The folder of the page must have the run's motion.csv (and those of further layers).
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { launch, look, open, seek, state } from './browser.mjs';
import { arrayOf, readCsv, readPayload, withPayload } from './payload.mjs';

const file = resolve(process.argv[2] ?? '');
const pictures = process.argv[3] && resolve(process.argv[3]);
if (!process.argv[2] || !existsSync(file)) {
    console.error('usage: node page_test.mjs REPORT.html [SCREENSHOTS]');
    process.exit(2);
}
if (pictures) mkdirSync(pictures, { recursive: true });

const html = readFileSync(file, 'utf8');
const payload = readPayload(html);
const { header } = payload;
const axes = [...header.machine.mandrel_chain, ...header.machine.eye_chain];
const scratch = mkdtempSync(join(tmpdir(), 'meshwind-page-'));

/** All programs with their place on the common clock and what motion.csv says of them. */
const programs = [];
header.layers.forEach((layer, l) => {
    layer.fibres.forEach((fibre, f) => {
        const suffix = `${l ? `-layer-${l + 1}` : ''}${f ? `-${f + 1}` : ''}`;
        const time = arrayOf(payload, `${fibre.prefix}time_s`);
        const start = programs.length ? programs[programs.length - 1].end : 0;
        programs.push({
            fibre,
            start,
            end: start + time[time.length - 1],
            time,
            line: arrayOf(payload, `${fibre.prefix}line`),
            rows: readCsv(readFileSync(join(dirname(file), `motion${suffix}.csv`), 'utf8')),
        });
    });
});
const duration = programs[programs.length - 1].end;

/** `count` blocks of a program, spread over it, and its first and last one. */
function someBlocks(program, count) {
    const last = program.rows.length - 1;
    return Array.from({ length: count }, (_, i) => Math.round((i * last) / (count - 1)));
}

/** A page with other data beside a copy of nothing: only the page itself. */
function variant(name, change) {
    const copy = readPayload(html);
    change(copy);
    const path = join(scratch, name);
    writeFileSync(path, withPayload(html, copy));
    return path;
}

/** Moves the slider as a hand does. */
function slide(page, time) {
    return page.evaluate((t) => {
        const slider = document.getElementById('slider');
        slider.value = String(t);
        slider.dispatchEvent(new Event('input', { bubbles: true }));
    }, time);
}

function picture(page, name) {
    return pictures ? page.screenshot({ path: join(pictures, `${name}.png`) }) : undefined;
}

const tests = [];
const test = (name, run) => tests.push({ name, run });

test('opens without a complaint and shows a picture', async (browser) => {
    const page = await open(browser, file);
    assert.deepEqual(page.complaints, []);
    const seen = await look(page, '#scene');
    assert.ok(seen.colours >= 20, `only ${seen.colours} colours`);
    assert.ok(seen.share > 0.03, `only ${seen.share} of the picture is drawn`);
    const box = await page.evaluate(() => {
        const { scrollWidth, scrollHeight } = document.documentElement;
        return [scrollWidth, scrollHeight];
    });
    assert.deepEqual(box, [1366, 768], 'the page must fit a laptop without scrolling');
    await picture(page, 'light');
});

test('slider turns the spindle as the program says', async (browser) => {
    const page = await open(browser, file);
    const chain = header.machine.mandrel_chain;
    const joint = chain.map((a) => a.type).lastIndexOf('rotary');
    const axis = chain[joint];
    const mount = header.machine.mount?.z ?? [0, 0, 1];
    const sign = Math.sign(axis.direction.reduce((sum, d, k) => sum + d * mount[k], 0));
    const off = (a, b) => Math.abs(((((a - b) % 360) + 540) % 360) - 180);
    for (const program of programs) {
        for (const block of someBlocks(program, 7).slice(1)) {
            for (const share of [1, 0.5]) {
                const [a, b] = [program.rows[block - 1], program.rows[block]];
                const time = a.time_s + share * (b.time_s - a.time_s);
                // Rounded up, the end of a program is already in the next one.
                await slide(page, Math.min(program.start + time, program.end));
                const now = await state(page);
                const turn = sign * (a[axis.letter] + share * (b[axis.letter] - a[axis.letter]));
                // Times are rounded to 1 us in the table; the spindle turns some 1000 deg/s at most.
                assert.ok(Math.abs(now.spindle_deg - turn) < 0.01, `${now.spindle_deg}, not ${turn}`);
                if (chain.length === 1) {
                    assert.ok(off(now.drawn_turn_deg, turn) < 0.01, `drawn at ${now.drawn_turn_deg}`);
                }
            }
        }
    }
});

test('eye is where the table of the motion has it', async (browser) => {
    const page = await open(browser, file);
    let compared = 0;
    let worst = 0;
    for (const program of programs) {
        const blocks = someBlocks(program, 120);
        const eyes = await page.evaluate(
            (times) =>
                times.map((t) => {
                    window.meshwind.seek(t);
                    return window.meshwind.state().eye_mm;
                }),
            blocks.map((b) => program.start + program.time[b]),
        );
        blocks.forEach((b, i) => {
            // The start of a further program is the same moment as the end of the one before.
            if (b === 0 && program.start > 0) return;
            const row = program.rows[b];
            const [x, y, z] = eyes[i];
            worst = Math.max(worst, Math.hypot(x - row.ex_mm, y - row.ey_mm, z - row.ez_mm));
            ++compared;
        });
    }
    assert.ok(compared >= 100);
    assert.ok(worst < 1e-3, `off by ${worst} mm`);
});

test('any chain, a mount and meshes of the machine are followed', async (browser) => {
    const { mandrel_chain: own, eye_chain: others } = header.machine;
    const upright = (d) => Math.abs(d[2]) === 1;
    if (own.length !== 1 || others[0].type !== 'linear' || ![own[0], others[0]].every((a) => upright(a.direction)) || header.machine.mount) {
        return 'needs a spindle and a carriage along it';
    }
    // The carriage's axis moves the mandrel the other way instead; the spindle's line is at c, and
    // the mandrel is mounted a quarter turn on and away: eye' = M^-1 (c + eye - R(-turn) c).
    const c = [5, 3];
    const origin = [10, 20, 30];
    const path = variant('chain.html', (copy) => {
        const { machine } = copy.header;
        const carriage = machine.eye_chain.shift();
        carriage.direction = carriage.direction.map((d) => -d);
        machine.mandrel_chain.unshift(carriage);
        machine.mandrel_chain[1].point = [...c, 0];
        machine.mount = { origin, x: [0, 1, 0], z: [0, 0, 1] };
        machine.bodies.push({ type: 'mesh', link: null, points: 'mandrel/points', faces: 'mandrel/faces' });
        machine.bodies.push({ type: 'capsule', link: own[0].letter, from: [0, 0, 0], to: [0, 0, 0], radius: 4 });
        const q = arrayOf(copy, `${programs[0].fibre.prefix}axes`);
        for (let i = 0; i < q.length; i += axes.length) [q[i], q[i + 1]] = [q[i + 1], q[i]];
    });
    const page = await open(browser, path);
    for (const block of someBlocks(programs[0], 40)) {
        await seek(page, programs[0].time[block]);
        const { eye_mm: eye } = await state(page);
        const row = programs[0].rows[block];
        const turn = (-row[own[0].letter] * own[0].direction[2] * Math.PI) / 180;
        const back = [
            c[0] * Math.cos(turn) - c[1] * Math.sin(turn),
            c[0] * Math.sin(turn) + c[1] * Math.cos(turn),
        ];
        const p = [c[0] + row.ex_mm - back[0] - origin[0], c[1] + row.ey_mm - back[1] - origin[1]];
        const expected = [p[1], -p[0], row.ez_mm - origin[2]];
        const off = Math.hypot(...expected.map((e, k) => e - eye[k]));
        assert.ok(off < 1e-3, `block ${block}: ${eye}, not ${expected}`);
    }
    assert.deepEqual(page.complaints, []);
    return undefined;
});

test('the fibre lands where the payload has it at the end of blocks', async (browser) => {
    const page = await open(browser, file);
    const program = programs[0];
    const stations = arrayOf(payload, `${program.fibre.prefix}station`);
    const positions = arrayOf(payload, `${program.fibre.prefix}position_mm`);
    const at = (station) => {
        const i = Math.min(Math.floor(station), positions.length / 3 - 2);
        return [0, 1, 2].map((k) => {
            const a = positions[3 * i + k];
            return a + (station - i) * (positions[3 * i + 3 + k] - a);
        });
    };
    const off = [];
    for (const block of someBlocks(program, 60)) {
        if (stations[block] < 0) continue;
        await seek(page, program.time[block]);
        const landed = at((await state(page)).station);
        off.push(Math.hypot(...at(stations[block]).map((x, k) => x - landed[k])));
    }
    off.sort((a, b) => a - b);
    // The drawn place is where the eye is in the tangent plane; a band's width apart is in sight.
    const width = header.tow.width_mm;
    assert.ok(off[Math.floor(0.9 * off.length)] < width, `nine in ten within ${off[Math.floor(0.9 * off.length)]} mm`);
});

test('a failed check says so, flies to its place and seeks its block', async (browser) => {
    const station = 0.4;
    const last = programs.length - 1;
    const place = { layer: 0, fibre: 0 };
    header.layers.forEach((layer, l) => layer.fibres.forEach((_, f) => Object.assign(place, { layer: l + 1, fibre: f + 1 })));
    const positions = arrayOf(payload, `${programs[last].fibre.prefix}position_mm`);
    const at = 3 * Math.floor((station * positions.length) / 3);
    place.position_mm = [...positions.subarray(at, at + 3)];
    place.block = Math.floor(station * programs[last].rows.length);
    const path = variant('failed.html', ({ header: changed }) => {
        changed.report.ok = false;
        const slip = changed.report.checks.slip;
        Object.assign(slip, { ok: false, worst: 1.5 * slip.limit, words: 'it <slips> here', place });
    });
    const page = await open(browser, path);
    const checks = Object.entries(header.report.checks);
    const failed = checks.filter(([name, check]) => name === 'slip' || !check.ok).length;
    assert.equal(await page.textContent('#verdict'), `${failed} of ${checks.length} checks failed`);
    const card = page.locator('[data-check="slip"]');
    assert.match(await card.getAttribute('class'), /failed/);
    assert.match(await card.textContent(), /It <slips> here/);
    await card.locator('button').click();
    const arrived = (to) =>
        window.meshwind.state().camera.target_mandrel_mm.every((c, k) => Math.abs(c - to[k]) < 0.01);
    await page.waitForFunction(arrived, place.position_mm, { timeout: 30000 }).catch(() => {});
    const now = await state(page);
    assert.equal(now.program, last);
    assert.equal(now.block, place.block);
    now.camera.target_mandrel_mm.forEach((c, k) => {
        assert.ok(Math.abs(c - place.position_mm[k]) < 0.01, `camera looks at ${now.camera.target_mandrel_mm}`);
    });
    await picture(page, 'failed_check');
});

test('plots draw, follow the axis chosen, and seek', async (browser) => {
    const page = await open(browser, file);
    await page.waitForTimeout(200);
    const first = await look(page, '#plot');
    assert.ok(first.colours >= 4 && first.share > 0.02);
    await page.click('#plot-axes button:last-child');
    await page.waitForTimeout(200);
    assert.notEqual((await look(page, '#plot')).sum, first.sum);
    const box = await page.locator('#plot').boundingBox();
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    const middle = (await state(page)).time_s;
    assert.ok(middle > 0.4 * duration && middle < 0.6 * duration, `at ${middle} of ${duration} s`);
    assert.equal(Number(await page.inputValue('#slider')).toFixed(3), middle.toFixed(3));
    await page.mouse.wheel(0, -400);
    await page.waitForTimeout(200);
    await page.mouse.click(box.x + box.width / 2 + 60, box.y + box.height / 2);
    const near = (await state(page)).time_s;
    assert.ok(near > middle && near - middle < 0.06 * duration, 'a stretched plot seeks finer');
});

test('a line of the program that is clicked is gone to', async (browser) => {
    const page = await open(browser, file);
    const program = programs[0];
    await page.click('#tab-program');
    await seek(page, program.time[Math.floor(program.time.length / 2)]);
    const here = await page.locator('.row.here').getAttribute('data-line');
    assert.equal(Number(here), program.line[(await state(page)).block]);
    const target = program.line[Math.floor(program.time.length / 2) + 4];
    await page.click(`.row[data-line="${target}"]`);
    assert.equal(program.line[(await state(page)).block], target);
    assert.equal(await page.locator('.row.here').getAttribute('data-line'), String(target));
    assert.ok((await page.locator('.row').count()) < 120, 'only lines in sight are in the page');
    await picture(page, 'program');
});

test('of the blocks of a looped line the nearest in time is gone to', async (browser) => {
    const loop = 5;
    const from = 20;
    const path = variant('loops.html', (copy) => {
        const line = arrayOf(copy, `${programs[0].fibre.prefix}line`);
        for (let b = 1; b < line.length; ++b) line[b] = from + (b % loop);
    });
    const page = await open(browser, path);
    await page.click('#tab-program');
    const block = Math.floor(programs[0].time.length / 3 / loop) * loop;
    await seek(page, programs[0].time[block]);
    await page.click(`.row[data-line="${from + 1}"]`);
    assert.equal((await state(page)).block, block + 1);
    await page.click(`.row[data-line="${from + 4}"]`);
    const { block: chosen } = await state(page);
    assert.ok(chosen === block - 1 || chosen === block + 4, `block ${chosen} from ${block}`);
});

test('keys play, step, jump, colour and help', async (browser) => {
    const page = await open(browser, file);
    await page.keyboard.press('Home');
    assert.equal((await state(page)).time_s, 0);
    await page.keyboard.press('ArrowRight');
    await page.keyboard.press('ArrowRight');
    assert.equal((await state(page)).block, 2);
    await page.keyboard.press('ArrowLeft');
    assert.equal((await state(page)).block, 1);
    await page.keyboard.press('ArrowDown');
    const course = await state(page);
    const piece = programs[0].fibre.pieces.find((p) => p.kind === 'course' && p.first > 0);
    if (piece) assert.ok(Math.abs(course.station - piece.first) < 30, `station ${course.station}`);
    await page.keyboard.press('Space');
    // Pictures come slowly without a graphics card: wait for the clock, not for a time.
    const goal = course.time_s + 1;
    await page.waitForFunction((t) => window.meshwind.state().time_s > t, goal, { timeout: 30000 });
    await page.keyboard.press('Space');
    assert.equal((await state(page)).playing, false);
    await page.keyboard.press('End');
    assert.ok(Math.abs((await state(page)).time_s - duration) < 1e-6);
    const sums = new Set();
    const names = ['course', 'family', 'slip', 'bridging', 'layers', 'thickness', 'angle'];
    for (const [i, name] of names.entries()) {
        await page.keyboard.press(String(i + 1));
        assert.equal((await state(page)).colouring, name);
        await page.waitForTimeout(150);
        sums.add((await look(page, '#scene')).sum);
        await picture(page, `colour_${name}`);
    }
    assert.ok(sums.size >= 6, 'colourings look different');
    await page.keyboard.press('m');
    assert.equal((await state(page)).mode, 'mandrel');
    await page.keyboard.press('?');
    assert.ok(await page.locator('dialog[open]').isVisible());
    await page.keyboard.press('Escape');
    assert.equal(await page.locator('dialog[open]').count(), 0);
    assert.deepEqual(page.complaints, []);
});

test('hover tells the numbers under the pointer', async (browser) => {
    const page = await open(browser, file);
    const box = await page.locator('#scene').boundingBox();
    let found = '';
    for (let i = 1; i < 12 && !/Course|Transition/.test(found); ++i) {
        await page.mouse.move(box.x + (box.width * i) / 12, box.y + box.height / 2);
        await page.waitForTimeout(60);
        found = await page.locator('#hover').innerText();
    }
    assert.match(found, /(Course|Transition) \d+/);
    assert.match(found, /slip/);
    assert.match(found, /region \d+/);
});

test('courses can be sorted, and lead to their time', async (browser) => {
    const page = await open(browser, file);
    await page.click('#tab-courses');
    await page.click('[data-sort="slip"]');
    const column = await page.locator('.courses thead th button').evaluateAll((all) =>
        all.findIndex((b) => b.dataset.sort === 'slip'),
    );
    const slips = await page
        .locator(`.courses tbody td:nth-child(${column + 1})`)
        .evaluateAll((cells) => cells.map((c) => Number(c.textContent)));
    assert.ok(slips.length > 0 && slips.every((s, i) => i === 0 || s <= slips[i - 1]));
    await page.locator('.courses tbody tr').first().click();
    const { time_s, station, program } = await state(page);
    const index = await page.locator('.courses tr.here').getAttribute('data-row');
    assert.ok(index !== null && time_s < duration);
    const worst = Math.max(...programs.flatMap((p) => p.fibre.pieces.map((piece) => piece.worst_slip)));
    const candidates = programs[program].fibre.pieces.filter((p) => p.worst_slip > worst - 6e-4);
    assert.ok(candidates.some((p) => Math.abs(p.first - station) < 30), `station ${station}`);
    await picture(page, 'courses');
});

test('a link opens at its moment', async (browser) => {
    const page = await open(browser, file, { hash: '#t=3.25' });
    assert.ok(Math.abs((await state(page)).time_s - 3.25) < 1e-6);
});

test('a layer can be shown alone', async (browser) => {
    if (header.layers.length < 2) return 'one layer only';
    const page = await open(browser, file);
    await page.selectOption('#layer', '1');
    const now = await state(page);
    assert.equal(now.layer, 2);
    const second = programs.find((p) => p.fibre === header.layers[1].fibres[0]);
    assert.ok(Math.abs(now.time_s - second.end) < 1e-6 || header.layers[1].fibres.length > 1);
    await page.keyboard.press('Home');
    assert.ok(Math.abs((await state(page)).time_s - second.start) < 1e-6);
    await page.click('#tab-layers');
    await picture(page, 'layers');
    return undefined;
});

test('without WebGL the page says so and keeps its tables', async (browser) => {
    const page = await open(browser, file, {
        before: () => {
            const original = HTMLCanvasElement.prototype.getContext;
            HTMLCanvasElement.prototype.getContext = function context(kind, ...rest) {
                return /webgl/.test(kind) ? null : original.call(this, kind, ...rest);
            };
        },
    });
    assert.match(await page.textContent('#notice'), /no WebGL/);
    assert.ok((await page.locator('.check').count()) > 0);
    await seek(page, 1);
    assert.equal((await state(page)).camera, null);
    assert.deepEqual(page.complaints, []);
    await picture(page, 'without_webgl');
});

test('without DecompressionStream the page unpacks its data itself', async (browser) => {
    const page = await open(browser, file, { before: () => delete window.DecompressionStream });
    assert.equal(await page.evaluate(() => typeof DecompressionStream), 'undefined');
    assert.ok((await page.locator('.check').count()) > 0);
    assert.deepEqual(page.complaints, []);
});

test('the empty template says that it has no data', async (browser) => {
    const path = join(scratch, 'empty.html');
    writeFileSync(path, html.replace(/<script id="meshwind-data"[^>]*>[^<]*<\/script>/, ''));
    const page = await open(browser, path);
    assert.match(await page.textContent('#notice'), /no data/);
});

test('dark, narrow and on paper', async (browser) => {
    const dark = await open(browser, file, { scheme: 'dark' });
    const luminance = (page) =>
        page.evaluate(() => {
            const [r, g, b] = getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number);
            return (r + g + b) / 3;
        });
    assert.ok((await luminance(dark)) < 60);
    await picture(dark, 'dark');
    await dark.click('#theme');
    assert.ok((await luminance(dark)) > 200);
    await dark.click('#theme');
    await dark.emulateMedia({ media: 'print', colorScheme: 'dark' });
    await dark.waitForTimeout(200);
    assert.ok((await luminance(dark)) > 200, 'paper is light');
    assert.ok(await dark.locator('#panel-courses').isVisible());
    assert.ok(!(await dark.locator('.transport').isVisible()));
    if (pictures) await dark.pdf({ path: join(pictures, 'paper.pdf'), format: 'A4' });
    const narrow = await open(browser, file, { viewport: { width: 420, height: 900 } });
    const wide = await narrow.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 420, `${wide} px wide`);
    if (pictures) await narrow.screenshot({ path: join(pictures, 'narrow.png'), fullPage: true });
    assert.deepEqual([...dark.complaints, ...narrow.complaints], []);
});

const browser = await launch();
let failures = 0;
for (const { name, run } of tests) {
    try {
        const skipped = await run(browser);
        console.log(`${skipped ? 'skip' : 'ok  '} ${name}${skipped ? ` (${skipped})` : ''}`);
    } catch (error) {
        ++failures;
        console.log(`FAIL ${name}\n     ${error.stack.split('\n').slice(0, 4).join('\n     ')}`);
    }
    await Promise.all(browser.contexts().map((context) => context.close()));
}
await browser.close();
rmSync(scratch, { recursive: true, force: true });
console.log(`${tests.length - failures} of ${tests.length} passed`);
process.exit(failures ? 1 : 0);
