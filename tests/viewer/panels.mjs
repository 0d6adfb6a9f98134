// The range of courses, all axes at once, the triad, folding, what the picture takes in, and the job sheet.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { open, seek, state } from './browser.mjs';
import { axes, duration, file, header, picture, pictures, programs, someBlocks, test, variant } from './run.mjs';

const courses = programs.flatMap((p) => p.fibre.pieces.filter((piece) => piece.kind === 'course'));
const kSizes = [
    { width: 1440, height: 900 },
    { width: 1280, height: 720 },
    { width: 390, height: 844 },
];

/** Moves one end of the range as a hand does. */
const pull = (page, id, value) =>
    page.evaluate(
        ([which, to]) => {
            const input = document.getElementById(which);
            input.value = String(to);
            input.dispatchEvent(new Event('input', { bubbles: true }));
        },
        [id, value],
    );

/** Pixels that have a colour, of a picture without machine and bare spots: mandrel and transitions are grey. */
function coloured(page) {
    return page.evaluate(async () => {
        // The next picture has what has just been asked for.
        for (let k = 0; k < 2; ++k) await new Promise(requestAnimationFrame);
        const canvas = document.getElementById('scene');
        const copy = document.createElement('canvas');
        [copy.width, copy.height] = [canvas.width, canvas.height];
        const paint = copy.getContext('2d');
        paint.drawImage(canvas, 0, 0);
        const { data } = paint.getImageData(0, 0, copy.width, copy.height);
        let count = 0;
        for (let i = 0; i < data.length; i += 4) {
            const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
            if (Math.max(r, g, b) - Math.min(r, g, b) > 40) ++count;
        }
        return count;
    });
}

test('a range of courses hides the bands before and after it', async (browser) => {
    if (courses.length < 4) return 'too few courses';
    const page = await open(browser, file);
    await page.locator('#show-machine').uncheck();
    await page.locator('#show-bare').uncheck();
    const all = await coloured(page);
    const end = courses.length - 1;
    const middle = Math.floor(end / 2);
    await pull(page, 'last-course', middle);
    assert.deepEqual((await state(page)).courses, [0, middle]);
    const lower = await coloured(page);
    assert.ok(lower < all, `${lower} of ${all} coloured`);
    await pull(page, 'first-course', middle);
    assert.deepEqual((await state(page)).courses, [middle, middle]);
    const one = await coloured(page);
    assert.ok(one > 0 && one < lower, `${one} of ${lower} coloured`);
    await picture(page, 'range');
    // What is not laid yet is not drawn, whatever the range.
    await seek(page, 0);
    assert.equal(await coloured(page), 0);
    await page.keyboard.press('a');
    assert.deepEqual((await state(page)).courses, [0, end]);
    assert.ok(await page.locator('#all-courses').isDisabled());
    await page.keyboard.press('End');
    assert.equal(await coloured(page), all);
    assert.deepEqual(page.complaints, []);
    return undefined;
});

test('the range goes by keys, numbers, layers and links', async (browser) => {
    if (courses.length < 4) return 'too few courses';
    const page = await open(browser, file);
    await page.focus('#first-course');
    for (const key of ['ArrowRight', 'ArrowRight', 'ArrowLeft']) await page.keyboard.press(key);
    await page.focus('#last-course');
    await page.keyboard.press('ArrowLeft');
    const end = courses.length - 1;
    const now = await state(page);
    assert.deepEqual(now.courses, [1, end - 1]);
    assert.ok(Math.abs(now.time_s - duration) < 1e-6, 'arrows of the range leave the clock');
    assert.match(await page.textContent('#range-words'), new RegExp(`${end - 1} of ${courses.length}$`));
    await page.keyboard.press('Home');
    assert.deepEqual((await state(page)).courses, [1, 1], 'the last is not before the first');
    await page.waitForFunction(() => location.hash.endsWith('courses=1-1'));
    await page.reload();
    await page.waitForFunction(() => document.body.classList.contains('ready'));
    assert.deepEqual((await state(page)).courses, [1, 1]);
    await page.click('#all-courses');
    assert.deepEqual((await state(page)).courses, [0, end]);
    // From the third course on, and up to it.
    await page.locator('#scene').focus();
    await page.keyboard.press('Home');
    const program = programs[0];
    const pieces = program.fibre.pieces.filter((p) => p.kind === 'course');
    for (let k = 0; k < 2; ++k) await page.keyboard.press('ArrowDown');
    await page.keyboard.press('ArrowRight');
    const { station } = await state(page);
    const under = pieces.filter((p) => p.first <= station).length - 1;
    await page.keyboard.press('b');
    assert.deepEqual((await state(page)).courses, [under, end]);
    await page.keyboard.press('e');
    assert.deepEqual((await state(page)).courses, [under, under]);
    if (header.layers.length > 1) {
        await page.selectOption('#layer', '0');
        const first = header.layers[0].fibres.flatMap((f) => f.pieces.filter((p) => p.kind === 'course'));
        assert.deepEqual((await state(page)).courses, [0, first.length - 1]);
    }
    await page.locator('#scene').focus();
    await page.keyboard.press('5');
    assert.ok(await page.locator('#first-course').isDisabled(), 'where faces are coloured no band is drawn');
    assert.deepEqual(page.complaints, []);
    return undefined;
});

test('all axes are told as the table of the motion has them', async (browser) => {
    const page = await open(browser, file);
    const read = () =>
        page.evaluate(() =>
            [...document.querySelectorAll('#axes tr')].map((row) => {
                const value = (cell) => Number(cell.textContent.replace(/\u2212/g, '-').replace(/[^\d.-]/g, ''));
                const mark = row.querySelector('.travel b');
                return {
                    letter: row.cells[0].textContent,
                    position: value(row.cells[1]),
                    speed: row.cells[2].textContent.startsWith('\u2013') ? NaN : value(row.cells[2]),
                    turns: mark ? null : value(row.cells[3]),
                    share: mark && Number(/translateX\(([\d.]+)%/.exec(mark.style.transform)[1]) / 100,
                };
            }),
        );
    for (const program of programs) {
        for (const block of someBlocks(program, 9).slice(1)) {
            await seek(page, Math.min(program.start + program.time[block], program.end));
            const rows = await read();
            const [before, at] = [program.rows[block - 1], program.rows[block]];
            assert.deepEqual(rows.map((r) => r.letter), axes.map((a) => a.letter));
            const span = program.time[block] - program.time[block - 1];
            rows.forEach((row, i) => {
                const q = at[axes[i].letter];
                assert.ok(Math.abs(row.position - q) < 0.0011, `${row.letter} at ${row.position}, not ${q}`);
                const speed = (q - before[row.letter]) / span;
                const close = 0.051 + 1e-3 / span;
                if (span > 1e-6) assert.ok(Math.abs(row.speed - speed) < close, `${row.speed}, not ${speed}`);
                const { min, max } = axes[i];
                if (row.share !== null) assert.ok(Math.abs(row.share - (q - min) / (max - min)) < 1e-3);
                else if (axes[i].type === 'rotary') assert.ok(Math.abs(row.turns - q / 360) < 0.0051);
            });
        }
    }
    assert.deepEqual(page.complaints, []);
});

test('a triad turns with the camera and names its frame', async (browser) => {
    for (const scheme of ['light', 'dark']) {
        const page = await open(browser, file, { scheme });
        const tips = () =>
            page.evaluate(() =>
                Object.fromEntries(
                    [...document.querySelectorAll('#triad g')].map((g) => {
                        const line = g.querySelector('line');
                        return [g.textContent, ['x2', 'y2'].map((a) => Number(line.getAttribute(a)))];
                    }),
                ),
            );
        const before = await tips();
        assert.deepEqual(Object.keys(before).sort(), ['X', 'Y', 'Z']);
        // An axis is drawn where the camera sees it.
        const { position, target } = (await state(page)).camera;
        const back = position.map((c, k) => c - target[k]);
        const size = Math.hypot(...back);
        ['X', 'Y', 'Z'].forEach((name, k) => {
            const length = Math.hypot(...before[name]) / 30;
            const expected = Math.sqrt(1 - (back[k] / size) ** 2);
            assert.ok(Math.abs(length - expected) < 0.01, `${name} is ${length} long, not ${expected}`);
        });
        assert.match(await page.getAttribute('#triad', 'aria-label'), /machine/);
        const box = await page.locator('#scene').boundingBox();
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        await page.mouse.down();
        await page.mouse.move(box.x + box.width / 2 + 90, box.y + box.height / 2 + 20, { steps: 3 });
        await page.mouse.up();
        await page.waitForTimeout(200);
        assert.notDeepEqual(await tips(), before);
        await page.keyboard.press('m');
        assert.match(await page.textContent('#triad'), /mandrel/);
        assert.deepEqual(page.complaints, []);
    }
});

test('panels fold and are resized, and the picture has their room', async (browser) => {
    const page = await open(browser, file, { viewport: kSizes[1] });
    const room = () =>
        page.evaluate(() => {
            const { clientWidth, clientHeight } = document.getElementById('scene');
            return [clientWidth, clientHeight];
        });
    const [width, height] = await room();
    await page.keyboard.press('s');
    await page.keyboard.press('p');
    assert.equal(await page.getAttribute('#fold-side', 'aria-expanded'), 'false');
    const [wide, high] = await room();
    assert.ok(wide > width + 300 && high > height + 150, `${wide} x ${high} from ${width} x ${height}`);
    await page.waitForFunction((w) => document.getElementById('scene').width === w, wide, { timeout: 30000 });
    await picture(page, 'folded');
    await page.reload();
    await page.waitForFunction(() => document.body.classList.contains('ready'));
    assert.deepEqual(await room(), [wide, high], 'it stays so');
    await page.click('#fold-side');
    await page.click('#fold-plots');
    assert.deepEqual(await room(), [width, height]);
    const border = await page.locator('#side-border').boundingBox();
    await page.mouse.move(border.x + 3, border.y + 200);
    await page.mouse.down();
    await page.mouse.move(border.x - 97, border.y + 200, { steps: 4 });
    await page.mouse.up();
    const [narrow, before] = await room();
    assert.equal(narrow, width - 100);
    await page.focus('#plots-border');
    await page.keyboard.press('ArrowDown');
    assert.equal((await room())[1], before + 24);
    assert.deepEqual(page.complaints, []);
});

for (const viewport of kSizes) {
    test(`part and head are in a picture of ${viewport.width} x ${viewport.height} all the time`, async (browser) => {
        const page = await open(browser, file, { viewport });
        const outside = () =>
            page.evaluate((end) => {
                let worst = 0;
                for (let k = 0; k <= 22; ++k) {
                    window.meshwind.seek((end * k) / 22);
                    const { part, head } = window.meshwind.state().camera;
                    worst = Math.max(worst, ...[...part, ...head].map(Math.abs));
                }
                return worst;
            }, duration);
        assert.ok((await outside()) < 1, 'as it opens');
        const width = await page.evaluate(() => document.documentElement.scrollWidth);
        assert.equal(width, viewport.width);
        await page.locator('#scene').hover();
        await page.mouse.wheel(0, -1500);
        await page.waitForTimeout(200);
        assert.ok((await outside()) > 1, 'near it, it is not all in sight');
        await page.click('#fit');
        assert.ok((await outside()) < 1, 'after Fit');
        await page.click('#on-mandrel');
        assert.ok((await outside()) < 1, 'with the camera on the mandrel');
    });
}

test('the job sheet has settings, layers and lines to sign', async (browser) => {
    const path = variant('job.html', ({ header: changed }) => {
        changed.report.run = {
            job: { tow: { width: 8 }, layers: [{ kind: 'helical', angle: 55 }], stops: [1, 2.5], note: '<b>' },
            seed: 7,
            effort: 2,
        };
    });
    const page = await open(browser, path, { viewport: { width: 690, height: 975 } });
    await page.click('#tab-job');
    assert.ok(await page.locator('.settings').isVisible());
    assert.ok(!(await page.locator('.signature').isVisible()));
    await page.keyboard.press('s');
    await page.emulateMedia({ media: 'print' });
    await page.waitForTimeout(200);
    const lines = await page
        .locator('.settings tr')
        .evaluateAll((rows) => rows.map((r) => [...r.cells].map((c) => c.textContent).join(' ')));
    assert.deepEqual(lines, [
        'tow.width 8',
        'layers.1.kind helical',
        'layers.1.angle 55',
        'stops 1, 2.5',
        'note <b>',
        'seed 7',
        'effort 2',
    ]);
    for (const name of ['job', 'layers', 'checks', 'courses']) assert.ok(await page.locator(`#panel-${name}`).isVisible(), name);
    assert.equal((await page.locator('.signature').innerText()).replace(/\s+/g, ' '), 'Wound by Date Checked by');
    const { report } = header;
    const layers = report.layers ?? [{ plan: report.plan, ...report.cost }];
    const head = await page.locator('.layers thead').innerText();
    for (const word of ['Asked', 'laid', 'Circuits', 'Starts', 'Dwell', 'Fibre', 'Mass', 'Time']) assert.ok(head.includes(word), word);
    for (const [i, layer] of layers.entries()) {
        const row = await page.locator('.layers tbody tr:not(.note)').nth(i).innerText();
        assert.ok(row.includes(layer.fibre_m.toFixed(1)), row);
        const { circuits } = layer.plan.pattern ?? {};
        if (circuits) assert.ok(row.split(/\s+/).includes(String(circuits)), row);
    }
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 690, `${wide} px wide`);
    if (pictures) await page.screenshot({ path: join(pictures, 'job_sheet.png'), fullPage: true });
    assert.deepEqual(page.complaints, []);
    const plain = await open(browser, file);
    if (!report.run) assert.equal(await plain.locator('#tab-job').count(), 0);
});
