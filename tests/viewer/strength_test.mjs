// What the page of `meshwind strength` shows and does, in a browser:
//   node strength_test.mjs STRENGTH.html [SCREENSHOTS]
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { look, open, pageAndPictures, runTests, withoutWebGl } from './browser.mjs';
import { arrayOf, readPayload } from './payload.mjs';

const { file, pictures } = pageAndPictures('strength_test.mjs STRENGTH.html');
const payload = readPayload(readFileSync(file, 'utf8'));
const { strength, text } = payload.header;
const state = (page) => page.evaluate(() => window.meshwindStrength.state());

const tests = [];
const test = (name, body) => tests.push({ name, body });

test('opens without a complaint and colours the wall by its utilisation', async (browser) => {
    const page = await open(browser, file);
    assert.deepEqual(page.complaints, []);
    assert.equal((await state(page)).colours, 'utilisation');
    const before = await look(page, '#scene');
    assert.ok(before.colours >= 20, `only ${before.colours} colours`);
    if (pictures) await page.screenshot({ path: join(pictures, 'strength.png') });
    await page.selectOption('#colouring', 'thickness');
    assert.notEqual((await look(page, '#scene')).sum, before.sum, 'the picture has changed');
    assert.match(await page.textContent('#legend'), /Thickness, mm/);
});

test('tells the first failure, and what is printed', async (browser) => {
    const page = await open(browser, file);
    const reserve = strength.first_failure.reserve;
    const shown = await page.textContent('#figures');
    assert.ok(shown.includes(reserve.toPrecision(3)), shown);
    assert.match(await page.textContent('#verdict'), reserve < 1 ? /A ply fails/ : /No ply fails/);
    assert.equal(await page.locator('[data-layer]').count(), strength.layers.length);
    await page.click('#tab-printed');
    assert.equal(await page.textContent('.printed'), text);
});

test('a row leads to the weakest place of its layer', async (browser) => {
    const page = await open(browser, file);
    await page.click('[data-layer="1"]');
    const at = strength.layers[0].position_mm;
    await page.waitForFunction((wanted) => {
        const { target } = window.meshwindStrength.state();
        return Math.hypot(...target.map((x, k) => x - wanted[k])) < 0.01;
    }, at);
    assert.equal(await page.locator('.label.here').count(), 1);
});

test('the triangle under the pointer tells at what it fails', async (browser) => {
    const page = await open(browser, file);
    const box = await page.locator('#scene').boundingBox();
    await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
    await page.waitForFunction(() => /shell \d/.test(document.getElementById('hover').textContent));
    const [, shell] = /shell (\d+)/.exec(await page.textContent('#hover'));
    const utilisation = arrayOf(payload, 'wall/utilisation')[shell - 1];
    assert.ok((await page.textContent('#hover')).includes((1 / utilisation).toPrecision(3)));
});

test('without WebGL the tables are there', async (browser) => {
    const page = await open(browser, file, { before: withoutWebGl });
    assert.match(await page.textContent('#notice'), /no WebGL/);
    assert.equal(await page.locator('[data-layer]').count(), strength.layers.length);
});

await runTests(tests, () => {});
