// What the page of a wall shows of it, in a browser:
//   node wall_test.mjs REPORT.html [SCREENSHOTS]
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { look, open, pageAndPictures, runTests } from './browser.mjs';
import { arrayOf, readPayload } from './payload.mjs';

const { file, pictures } = pageAndPictures('wall_test.mjs REPORT.html');
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
    // The middle of the pipe; the head is in the frame, too, so that this is not the middle of the picture.
    const [left, right, lower, upper] = (await state(page)).camera.part;
    await page.mouse.move(box.x + (0.5 + 0.25 * (left + right)) * box.width, box.y + (0.5 - 0.25 * (lower + upper)) * box.height);
    await page.waitForFunction(() => /wall/.test(document.getElementById('hover').textContent));
    const [, laid, asked] = /wall\s*([\d.]+) of (\d+) layers/.exec(await page.textContent('#hover'));
    const face = arrayOf(payload, 'wall/asked_layers').findIndex(
        (n, f) => n === Number(asked) && Math.abs(arrayOf(payload, 'wall/laid_layers')[f] - laid) < 0.006,
    );
    assert.ok(face >= 0, `no face has ${laid} of ${asked} layers`);
});

await runTests(tests, () => {});
