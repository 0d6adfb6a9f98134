// What the page of `inspect --page` shows and does, in a browser:
//   node part_test.mjs PART.html [SCREENSHOTS]
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { darkAndOnPaper, look, narrowPage, open, pageAndPictures, runTests, withoutWebGl } from './browser.mjs';
import { arrayOf, readPayload, withPayload } from './payload.mjs';

const { file, pictures } = pageAndPictures('part_test.mjs PART.html');
const html = readFileSync(file, 'utf8');
const payload = readPayload(html);
const { mandrel } = payload.header.inspection;
const scratch = mkdtempSync(join(tmpdir(), 'meshwind-part-'));
const picture = (page, name) =>
    pictures ? page.screenshot({ path: join(pictures, `${name}.png`) }) : undefined;
const state = (page) => page.evaluate(() => window.meshwindPart.state());

const tests = [];
const test = (name, body) => tests.push({ name, body });

/** The words of an element with every blank one space. */
const words = async (page, selector) =>
    (await page.locator(selector).textContent()).replace(/\s+/g, ' ').trim();

const kWound = [0x56, 0xb4, 0xe9];
const kBore = [0x00, 0x9e, 0x73];

test('opens without a complaint and shows the part in its colours', async (browser) => {
    const page = await open(browser, file);
    assert.deepEqual(page.complaints, []);
    const seen = await look(page, '#scene', [kWound]);
    assert.ok(seen.colours >= 20, `only ${seen.colours} colours`);
    const [wound] = seen.near;
    assert.ok(wound > 0.03, `only ${wound} of the picture is wound wall`);
    const box = await page.evaluate(() => {
        const { scrollWidth, scrollHeight } = document.documentElement;
        return [scrollWidth, scrollHeight];
    });
    assert.deepEqual(box, [1366, 768], 'the page must fit a laptop without scrolling');
    await picture(page, 'part_light');
});

test('the lists are those of inspect', async (browser) => {
    const page = await open(browser, file);
    assert.equal(await page.textContent('#title'), mandrel.file);
    assert.equal(await page.locator('.regions tbody tr').count(), mandrel.regions.length);
    assert.equal(await page.locator('.rims tbody tr').count(), mandrel.rims.length);
    assert.equal(await page.locator('.remarks li').count(), mandrel.remarks.length);
    for (const [i, remark] of mandrel.remarks.entries()) {
        const shown = await words(page, `.remarks li >> nth=${i}`);
        assert.equal(shown.slice(String(i + 1).length + 1), remark.replace(/\s+/g, ' ').slice(1));
    }
    for (const rim of mandrel.rims) {
        assert.ok((await words(page, `[data-rim="${rim.id}"]`)).includes(rim.radius.toFixed(3)));
    }
    for (const key of ['Unit', 'Size', 'Spindle axis', 'Surface', 'Accuracy']) {
        const line = payload.header.text.split('\n').find((l) => l.startsWith(key.toLowerCase()));
        const row = page.locator(`.shape dt:text-is("${key}") + dd`);
        assert.equal((await row.textContent()).trim(), line.slice(14).trim(), key);
    }
    await page.click('#tab-printed');
    assert.equal(await page.locator('.printed').textContent(), payload.header.text);
    await picture(page, 'part_printed');
});

test('each rim and each place of a remark has a label, none over another', async (browser) => {
    const page = await open(browser, file);
    const boxes = await page.evaluate(() =>
        [...document.querySelectorAll('.label')].map((label) => {
            const { left, right, top, bottom } = label.getBoundingClientRect();
            return { id: label.dataset.label, hidden: label.hidden, left, right, top, bottom };
        }),
    );
    assert.equal(boxes.length, mandrel.rims.length + mandrel.places.length + 1);
    const shown = boxes.filter((b) => !b.hidden);
    for (const rim of mandrel.rims) assert.ok(shown.some((b) => b.id === `rim-${rim.id}`));
    for (const [i, a] of shown.entries()) {
        for (const b of shown.slice(i + 1)) {
            const apart = a.right <= b.left || b.right <= a.left || a.bottom <= b.top || b.bottom <= a.top;
            assert.ok(apart, `${a.id} lies over ${b.id}`);
        }
    }
});

test('a rim and a remark lead to their places', async (browser) => {
    const page = await open(browser, file);
    const arrives = async (to, within) => {
        const near = ([x, y, z, r]) => {
            const t = window.meshwindPart.state().target;
            return Math.hypot(t[0] - x, t[1] - y, t[2] - z) < r;
        };
        await page.waitForFunction(near, [...to, within], { timeout: 30000 });
    };
    const [rim] = mandrel.rims;
    if (rim) {
        await page.click(`[data-rim="${rim.id}"]`);
        await arrives(rim.centre, 1.5 * rim.radius + 1);
        assert.match(await page.locator(`[data-rim="${rim.id}"]`).getAttribute('class'), /here/);
    }
    const [place] = mandrel.places;
    if (!place) return 'no remark has a place';
    await page.click(`[data-remark="${place.remark}"]`);
    await arrives(place.at, 0.01);
    await picture(page, 'part_place');
    assert.deepEqual(page.complaints, []);
});

test('each line that might be the spindle is told, and drawn under the pointer', async (browser) => {
    const page = await open(browser, file);
    const { candidates } = mandrel.axis;
    assert.equal(await page.locator('.axes tbody tr:not(.note)').count(), candidates.length);
    for (const [i, axis] of candidates.entries()) {
        const rows = page.locator(`[data-axis="${i}"]`);
        assert.ok((await rows.nth(0).textContent()).includes(axis.rule));
        assert.equal((await rows.nth(1).textContent()).slice(1), axis.why.slice(1));
    }
    const before = (await look(page, '#scene')).sum;
    const last = page.locator(`[data-axis="${candidates.length - 1}"] >> nth=0`);
    await last.scrollIntoViewIfNeeded();
    await last.hover();
    await page.waitForTimeout(250);
    assert.notEqual((await look(page, '#scene')).sum, before);
    await picture(page, 'part_axes');
    await page.locator('h3 >> nth=0').hover();
    await page.waitForTimeout(250);
    assert.equal((await look(page, '#scene')).sum, before);
    assert.deepEqual(page.complaints, []);
});

test('cut open the inside is seen; triangles, marks and colours change the picture', async (browser) => {
    const page = await open(browser, file);
    const drawn = async () => {
        await page.waitForTimeout(250);
        return (await look(page, '#scene')).sum;
    };
    const first = await drawn();
    const bore = async () => (await look(page, '#scene', [kBore])).near[0];
    const closed = await bore();
    await page.click('#cut');
    assert.notEqual(await drawn(), first);
    assert.equal((await state(page)).cut, true);
    const opened = await bore();
    if (mandrel.regions.some((r) => r.kind === 'bore')) {
        assert.ok(opened > closed + 0.005, `${opened} of the picture is bore, ${closed} before`);
    }
    await picture(page, 'part_cut');
    await page.keyboard.press('c');
    assert.equal(await drawn(), first);
    await page.keyboard.press('t');
    const triangles = await drawn();
    assert.notEqual(triangles, first);
    await picture(page, 'part_triangles');
    await page.click('#marks');
    assert.notEqual(await drawn(), triangles);
    assert.ok(!(await page.locator('#labels').isVisible()));
    await page.selectOption('#colouring', 'region');
    await drawn();
    assert.match(await page.textContent('#legend'), /region 0/);
    await picture(page, 'part_regions');
    assert.deepEqual(page.complaints, []);
});

test('the pointer tells region and place, in the frame of the file too', async (browser) => {
    const page = await open(browser, file);
    const canvas = await page.locator('#scene').boundingBox();
    let told = '';
    for (let k = 1; k < 40 && !told; ++k) {
        await page.mouse.move(canvas.x + canvas.width / 2, canvas.y + (canvas.height * k) / 40);
        await page.waitForTimeout(60);
        if (await page.locator('#hover').isVisible()) told = await page.textContent('#hover');
    }
    assert.match(told, /Region \d+, |Taken off/);
    assert.match(told, /file x y z/);
    const region = Number(/Region (\d+)/.exec(told)?.[1] ?? 0);
    assert.ok(region < mandrel.regions.length);
});

test('a refused part says so first', async (browser) => {
    const copy = readPayload(html);
    copy.header.refused = 'rim 0 is <no> circle';
    const path = join(scratch, 'refused.html');
    writeFileSync(path, withPayload(html, copy));
    const page = await open(browser, path);
    assert.equal(await page.textContent('#verdict'), 'The main job refuses it');
    assert.match(await page.textContent('.refused'), /rim 0 is <no> circle/);
    await picture(page, 'part_refused');
});

test('a part without rims, remarks or wall to mark is shown', async (browser) => {
    const copy = readPayload(html);
    Object.assign(copy.header.inspection.mandrel, { rims: [], remarks: [], places: [] });
    arrayOf(copy, 'part/sharp').fill(0);
    const path = join(scratch, 'plain.html');
    writeFileSync(path, withPayload(html, copy));
    const page = await open(browser, path);
    assert.equal(await page.locator('.label').count(), 1);
    assert.match(await page.textContent('#panel-part'), /closed/);
    assert.deepEqual(page.complaints, []);
});

test('without WebGL the page says so and keeps its lists', async (browser) => {
    const page = await open(browser, file, {
        before: withoutWebGl,
    });
    assert.match(await page.textContent('#notice'), /no WebGL/);
    assert.equal(await page.locator('.rims tbody tr').count(), mandrel.rims.length);
    assert.deepEqual(page.complaints, []);
});

test('dark, narrow and on paper', async (browser) => {
    const dark = await darkAndOnPaper(browser, file, (page) => picture(page, 'part_dark'));
    assert.ok(await dark.locator('#panel-printed').isVisible());
    const narrow = await narrowPage(browser, file);
    if (pictures) await narrow.screenshot({ path: join(pictures, 'part_narrow.png'), fullPage: true });
    assert.deepEqual([...dark.complaints, ...narrow.complaints], []);
});

await runTests(tests, () => rmSync(scratch, { recursive: true, force: true }));
