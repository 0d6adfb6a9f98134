// What clicks, keys, pointer and links do.
import assert from 'node:assert/strict';
import { look, open, seek, state } from './browser.mjs';
import { arrayOf } from './payload.mjs';
import { duration, file, header, payload, picture, programs, test, variant } from './run.mjs';

test('a failed check says so, flies to its place and seeks its block', async (browser) => {
    const station = 0.4;
    const last = programs.length - 1;
    const place = { layer: 0, fibre: 0 };
    header.layers.forEach((layer, l) =>
        layer.fibres.forEach((_, f) => Object.assign(place, { layer: l + 1, fibre: f + 1 })),
    );
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
        assert.ok(
            Math.abs(c - place.position_mm[k]) < 0.01,
            `camera looks at ${now.camera.target_mandrel_mm}`,
        );
    });
    await picture(page, 'failed_check');
});

test('plots draw, follow the axis chosen, and seek', async (browser) => {
    const page = await open(browser, file);
    await page.waitForTimeout(200);
    const first = await look(page, '#plot');
    assert.ok(first.colours >= 4 && first.share > 0.02);
    await page.click('#axes tr:last-child button');
    await page.waitForTimeout(200);
    assert.notEqual((await look(page, '#plot')).sum, first.sum);
    const box = await page.locator('#plot').boundingBox();
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    const middle = (await state(page)).time_s;
    assert.ok(middle > 0.4 * duration && middle < 0.6 * duration, `at ${middle} of ${duration} s`);
    assert.equal(Number(await page.inputValue('#slider')).toFixed(3), middle.toFixed(3));
    await page.mouse.wheel(0, -400);
    await page.waitForTimeout(200);
    await page.mouse.click(box.x + 0.56 * box.width, box.y + box.height / 2);
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
    // Fibre lies on extensions too: along the middle of the picture, the first place where it lies on the mandrel.
    let found = '';
    for (let i = 1; i < 48 && !/(Course|Transition)[^]*region/.test(found); ++i) {
        await page.mouse.move(box.x + (box.width * i) / 48, box.y + box.height / 2);
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
    const column = await page
        .locator('.courses thead th button')
        .evaluateAll((all) => all.findIndex((b) => b.dataset.sort === 'slip'));
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
    assert.ok(
        candidates.some((p) => Math.abs(p.first - station) < 30),
        `station ${station}`,
    );
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
