// A browser without network and with software WebGL, and a page that notes whatever goes wrong.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { pathToFileURL } from 'node:url';

const require = createRequire(new URL('../../viewer/package.json', import.meta.url));
const { chromium } = require('playwright-core');

const kLaptop = { width: 1366, height: 768 };
const kPlaces = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];

export function launch() {
    const executablePath = process.env.CHROMIUM ?? kPlaces.find((place) => existsSync(place));
    if (!executablePath) throw new Error('no chromium found; name it in CHROMIUM');
    return chromium.launch({
        executablePath,
        args: [
            '--headless=new',
            '--no-sandbox',
            '--disable-quic',
            '--no-first-run',
            '--disable-background-networking',
            '--disable-component-update',
            '--disable-sync',
            '--use-gl=angle',
            '--use-angle=swiftshader',
            '--enable-unsafe-swiftshader',
        ],
    });
}

/** The page and the folder for pictures, if there is one, of the command line. `usage`: what it is without the latter. */
export function pageAndPictures(usage) {
    const file = resolve(process.argv[2] ?? '');
    const pictures = process.argv[3] && resolve(process.argv[3]);
    if (!process.argv[2] || !existsSync(file)) {
        console.error(`usage: node ${usage} [SCREENSHOTS]`);
        process.exit(2);
    }
    if (pictures) mkdirSync(pictures, { recursive: true });
    return { file, pictures };
}

/**
 * Opens a file and waits until it is drawn.
 * `options`: viewport, scheme ("light" or "dark"), hash, before (script run first), mayFail.
 * `page.complaints` lists errors, warnings of the console and requests beyond the file itself.
 */
export async function open(browser, file, options = {}) {
    const context = await browser.newContext({
        viewport: options.viewport ?? kLaptop,
        colorScheme: options.scheme ?? 'light',
    });
    const page = await context.newPage();
    page.complaints = [];
    page.on('console', (message) => {
        if (['error', 'warning'].includes(message.type()) && !isDriverRemark(message.text())) {
            page.complaints.push(`console: ${message.text()}`);
        }
    });
    page.on('pageerror', (error) => page.complaints.push(`error: ${error.message}`));
    page.on('requestfailed', (request) => page.complaints.push(`failed: ${request.url()}`));
    page.on('request', (request) => {
        if (/^(https?|wss?|ftp):/.test(request.url())) page.complaints.push(`network: ${request.url()}`);
    });
    if (options.before) await page.addInitScript(options.before);
    await page.goto(pathToFileURL(file).href + (options.hash ?? ''));
    await page.waitForFunction(
        () => document.body.classList.contains('ready') || document.body.classList.contains('failed'),
        null,
        { timeout: 120000 },
    );
    return page;
}

/** Reading pixels back is slow on purpose here; software drivers remark on it. */
function isDriverRemark(text) {
    return /GPU stall due to ReadPixels|Automatic fallback to software WebGL/.test(text);
}

/** Script to run first in a browser that is to have no WebGL. */
export function withoutWebGl() {
    const original = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function context(kind, ...rest) {
        return /webgl/.test(kind) ? null : original.call(this, kind, ...rest);
    };
}

/** Of the page's ground, 0..255. */
const luminance = (page) =>
    page.evaluate(() => {
        const [r, g, b] = getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number);
        return (r + g + b) / 3;
    });

export const state = (page) => page.evaluate(() => window.meshwind.state());
export const seek = (page, time) => page.evaluate((t) => window.meshwind.seek(t), time);

/**
 * {colours, share, sum, near}: how many colours a canvas shows (5 bits each), the share off its corner's, a sum
 * that tells two pictures apart, and for each of the hues given the share of the picture that has it, whatever its shade.
 */
export function look(page, selector, hues = []) {
    return page.evaluate(([s, wanted]) => {
        const canvas = document.querySelector(s);
        const copy = document.createElement('canvas');
        copy.width = canvas.width;
        copy.height = canvas.height;
        const paint = copy.getContext('2d');
        paint.drawImage(canvas, 0, 0);
        const { data } = paint.getImageData(0, 0, copy.width, copy.height);
        const key = (i) => (data[i] >> 3) | ((data[i + 1] >> 3) << 5) | ((data[i + 2] >> 3) << 10);
        const ground = key(0);
        const colours = new Map();
        let off = 0;
        let sum = 0;
        const near = wanted.map(() => 0);
        for (let i = 0; i < data.length; i += 4) {
            colours.set(key(i), (colours.get(key(i)) ?? 0) + 1);
            if (key(i) !== ground) ++off;
            sum = (sum * 31 + key(i) + data[i + 3]) % 1000000007;
            const size = Math.hypot(data[i], data[i + 1], data[i + 2]) || 1;
            wanted.forEach((hue, k) => {
                const dot = hue[0] * data[i] + hue[1] * data[i + 1] + hue[2] * data[i + 2];
                if (dot > 0.995 * size * Math.hypot(...hue)) ++near[k];
            });
        }
        const seen = [...colours.values()].filter((n) => n > 20).length;
        const share = (n) => (4 * n) / data.length;
        return { colours: seen, share: share(off), sum, near: near.map(share) };
    }, [selector, hues]);
}

/** Follows the system's scheme and the page's own switch, and is light on paper. Returns the page as it is for paper. */
export async function darkAndOnPaper(browser, file, picture) {
    const page = await open(browser, file, { scheme: 'dark' });
    assert.ok((await luminance(page)) < 60);
    await picture(page);
    await page.click('#theme');
    assert.ok((await luminance(page)) > 200);
    await page.click('#theme');
    await page.emulateMedia({ media: 'print', colorScheme: 'dark' });
    await page.waitForTimeout(200);
    assert.ok((await luminance(page)) > 200, 'paper is light');
    return page;
}

/** Fits a phone's width. Returns the page. */
export async function narrowPage(browser, file) {
    const page = await open(browser, file, { viewport: { width: 420, height: 900 } });
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= 420, `${wide} px wide`);
    return page;
}

/** Runs tests of {name, body} one after the other, and ends the process: 1 where one failed. */
export async function runTests(tests, tidy) {
    const browser = await launch();
    let failures = 0;
    for (const { name, body } of tests) {
        try {
            const skipped = await body(browser);
            console.log(`${skipped ? 'skip' : 'ok  '} ${name}${skipped ? ` (${skipped})` : ''}`);
        } catch (error) {
            ++failures;
            console.log(`FAIL ${name}\n     ${error.stack.split('\n').slice(0, 4).join('\n     ')}`);
        }
        await Promise.all(browser.contexts().map((context) => context.close()));
    }
    await browser.close();
    tidy();
    console.log(`${tests.length - failures} of ${tests.length} passed`);
    process.exit(failures ? 1 : 0);
}
