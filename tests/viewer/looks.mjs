// What the page looks like, also in poor browsers and on paper.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { darkAndOnPaper, look, narrowPage, open, seek, state, withoutWebGl } from './browser.mjs';
import { file, html, picture, pictures, programs, scratch, test, variant } from './run.mjs';

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

test('without WebGL the page says so and keeps its tables', async (browser) => {
    const page = await open(browser, file, {
        before: withoutWebGl,
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

test('a fibre without blocks is shown as it lies', async (browser) => {
    const path = variant('standstill.html', (copy) => {
        for (const { fibre } of programs) {
            for (const name of ['time_s', 'asked_s', 'axes', 'eye_mm', 'station', 'line', 'text']) {
                copy.header.arrays[fibre.prefix + name].count = 0;
            }
        }
    });
    const page = await open(browser, path);
    assert.ok((await look(page, '#scene')).colours >= 20);
    for (const tab of ['courses', 'bare', 'program']) await page.click(`#tab-${tab}`);
    assert.match(await page.textContent('#panel-program'), /No program was written/);
    for (const key of ['ArrowRight', 'ArrowDown', 'Home', 'Space']) await page.keyboard.press(key);
    assert.deepEqual(page.complaints, []);
});

test('the empty template says that it has no data', async (browser) => {
    const path = join(scratch, 'empty.html');
    writeFileSync(path, html.replace(/<script id="meshwind-data"[^>]*>[^<]*<\/script>/, ''));
    const page = await open(browser, path);
    assert.match(await page.textContent('#notice'), /no data/);
});

test('dark, narrow and on paper', async (browser) => {
    const dark = await darkAndOnPaper(browser, file, (page) => picture(page, 'dark'));
    assert.ok(await dark.locator('#panel-courses').isVisible());
    assert.ok(!(await dark.locator('.transport').isVisible()));
    if (pictures) await dark.pdf({ path: join(pictures, 'paper.pdf'), format: 'A4' });
    const narrow = await narrowPage(browser, file);
    if (pictures) await narrow.screenshot({ path: join(pictures, 'narrow.png'), fullPage: true });
    assert.deepEqual([...dark.complaints, ...narrow.complaints], []);
});
