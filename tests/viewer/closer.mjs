// What one looks closer with: section, measuring, travel.
import assert from 'node:assert/strict';
import { look, open, seek } from './browser.mjs';
import { axes, duration, file, header, picture, test } from './run.mjs';

const kMm = 0.11; // the card under the pointer is rounded to 0.1 mm

/** What the card under the pointer says of its place; null: the pointer is beside the part. */
async function placeAt(page, x, y) {
    await page.mouse.move(x, y);
    await page.waitForTimeout(30);
    const words = await page.locator('#hover').innerText();
    const found = /at x y z\s+(\S+)\s+(\S+)\s+(\S+)/.exec(words);
    return found && found.slice(1).map((c) => Number(c.replace('\u2212', '-').replaceAll('\u202f', '')));
}

/** Places of the part over all the picture, with where they are seen. */
async function places(page, across = 12, down = 8) {
    const box = await page.locator('#scene').boundingBox();
    const found = [];
    for (let i = 1; i < across; ++i) {
        for (let k = 1; k < down; ++k) {
            const [x, y] = [box.x + (box.width * i) / across, box.y + (box.height * k) / down];
            const at = await placeAt(page, x, y);
            if (at) found.push({ x, y, at });
        }
    }
    return found;
}

/** The part alone, standing still. */
async function openPart(browser) {
    const page = await open(browser, file);
    await page.click('#on-mandrel');
    await page.uncheck('#show-machine');
    await page.waitForTimeout(300);
    return page;
}

const slideTo = (page, share) =>
    page.evaluate((s) => {
        const slider = document.getElementById('section-at');
        slider.value = String(Number(slider.min) + s * (Number(slider.max) - Number(slider.min)));
        slider.dispatchEvent(new Event('input', { bubbles: true }));
        return Number(slider.value);
    }, share);

test('a section takes away what lies beyond it, to the eye and to the pointer', async (browser) => {
    const page = await openPart(browser);
    assert.ok(await page.locator('#section-at').isHidden());
    const share = async () => {
        await page.waitForTimeout(100);
        return (await look(page, '#scene')).share;
    };
    const whole = await share();
    for (const [k, axis] of ['x', 'y', 'z'].entries()) {
        await page.selectOption('#section', axis);
        await slideTo(page, 1);
        assert.ok((await share()) > 0.97 * whole, 'nothing is cut at the end');
        const before = Math.max(...(await places(page)).map(({ at }) => at[k]));
        const at = await slideTo(page, 0.4);
        const seen = await places(page);
        assert.ok(seen.length > 0, 'some of the part is left');
        assert.ok(before > at, 'so far the part was seen beyond there');
        for (const place of seen) assert.ok(place.at[k] <= at + kMm, `${axis} ${place.at[k]} beyond ${at}`);
        assert.ok((await share()) < 0.97 * whole, 'less of the part is drawn');
        assert.match(await page.locator('#section-words').innerText(), new RegExp(`^${axis} = `));
    }
    await picture(page, 'section');
    // It turns with the mandrel.
    await page.click('#with-machine');
    await seek(page, duration / 3);
    const z = await page.evaluate(() => Number(document.getElementById('section-at').value));
    for (const place of await places(page)) assert.ok(place.at[2] <= z + kMm);
    await page.selectOption('#section', '');
    await page.click('#on-mandrel');
    await page.click('#fit');
    assert.ok((await share()) > 0.97 * whole, 'all of it is back');
    assert.deepEqual(page.complaints, []);
});

test('a distance is that of the two places clicked', async (browser) => {
    const page = await openPart(browser);
    const seen = await places(page);
    const [from, to] = [seen[0], seen[seen.length - 1]];
    await page.mouse.click(from.x, from.y);
    assert.ok(await page.locator('#measured').isHidden(), 'a click measures nothing before');
    await page.keyboard.press('d');
    assert.match(await page.locator('#measured').innerText(), /Click a place/);
    await page.mouse.click(from.x, from.y);
    assert.match(await page.locator('#measured').innerText(), /the other place/);
    await page.mouse.click(to.x, to.y);
    const words = (await page.locator('#measured').innerText()).replaceAll('\u2212', '-').replaceAll('\u202f', ' ');
    const number = (pattern) => Number(pattern.exec(words)[1]);
    const near = (got, want, by) => assert.ok(Math.abs(got - want) <= by, `${got} for ${want}: ${words}`);
    const turn = Math.atan2(to.at[1], to.at[0]) - Math.atan2(from.at[1], from.at[0]);
    const radius = Math.min(Math.hypot(...from.at.slice(0, 2)), Math.hypot(...to.at.slice(0, 2)));
    near(number(/([\d.]+) mm apart/), Math.hypot(...to.at.map((c, k) => c - from.at[k])), 2 * kMm);
    near(number(/along the spindle\s+(\S+) mm/), to.at[2] - from.at[2], 2 * kMm);
    const degrees = (number(/around it\s+(\S+)°/) * Math.PI) / 180;
    near(Math.atan2(Math.sin(degrees - turn), Math.cos(degrees - turn)), 0, (3 * kMm) / radius);
    await picture(page, 'measured');
    // A drag turns the view and takes no place; a third click begins anew; the key ends it.
    await page.mouse.move(to.x, to.y);
    await page.mouse.down();
    await page.mouse.move(to.x + 40, to.y + 10);
    await page.mouse.up();
    assert.match(await page.locator('#measured').innerText(), /apart/);
    await page.click('#fit');
    await page.waitForTimeout(100);
    await page.mouse.click(from.x, from.y);
    assert.match(await page.locator('#measured').innerText(), /the other place/);
    await page.keyboard.press('d');
    assert.ok(await page.locator('#measured').isHidden());
    assert.equal(await page.getAttribute('#measure', 'aria-pressed'), 'false');
    assert.deepEqual(page.complaints, []);
});

test('the travel of the linear axes is drawn on demand', async (browser) => {
    const linear = axes.slice(header.machine.mandrel_chain.length).filter((axis) => axis.type === 'linear');
    const page = await open(browser, file);
    if (!linear.length) {
        assert.ok(await page.locator('#travel-label').isHidden());
        return;
    }
    const before = await look(page, '#scene');
    await page.check('#show-travel');
    await page.waitForTimeout(100);
    assert.notEqual((await look(page, '#scene')).sum, before.sum);
    await page.uncheck('#show-travel');
    await page.waitForTimeout(100);
    assert.equal((await look(page, '#scene')).sum, before.sum);
    assert.deepEqual(page.complaints, []);
});
