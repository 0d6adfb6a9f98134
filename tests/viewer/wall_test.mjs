// What the page of a wall shows of it, in a browser:
//   node wall_test.mjs REPORT.html [SCREENSHOTS]
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { look, open, runTests } from './browser.mjs';
import { arrayOf, readPayload } from './payload.mjs';

const file = resolve(process.argv[2] ?? '');
const pictures = process.argv[3] && resolve(process.argv[3]);
if (!process.argv[2] || !existsSync(file)) {
    console.error('usage: node wall_test.mjs REPORT.html [SCREENSHOTS]');
    process.exit(2);
}
if (pictures) mkdirSync(pictures, { recursive: true });
const payload = readPayload(readFileSync(file, 'utf8'));
const state = (page) => page.evaluate(() => window.meshwind.state());

const tests = [];
const test = (name, body) => tests.push({ name, body });

test('the wall is coloured by what lies there over what was asked for', async (browser) => {
    const page = await open(browser, file);
    await page.keyboard.press('7');
    const before = (await look(page, '#scene')).sum;
    await page.keyboard.press('8');
    assert.equal((await state(page)).colouring, 'wall');
    assert.notEqual((await look(page, '#scene')).sum, before, 'the picture has changed');
    assert.match(await page.textContent('#legend'), /Wall, ×.*0.*1.*2/s);
    if (pictures) await page.screenshot({ path: join(pictures, 'wall.png') });
    assert.deepEqual(page.complaints, []);
});

test('the face under the pointer tells both', async (browser) => {
    const page = await open(browser, file);
    await page.keyboard.press('8');
    const box = await page.locator('#scene').boundingBox();
    await page.mouse.move(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
    await page.waitForFunction(() => /asked/.test(document.getElementById('hover').textContent));
    const asked = Number(/asked\s*(\d+)/.exec(await page.textContent('#hover'))[1]);
    assert.ok(arrayOf(payload, 'wall/asked_layers').includes(asked), `${asked} layers`);
});

await runTests(tests, () => {});
