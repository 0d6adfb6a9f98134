// What report.html shows and does, in a browser:
//   node page_test.mjs REPORT.html [SCREENSHOTS]
// The folder of the page must have the run's motion.csv (and those of further layers and fibres).
import { launch } from './browser.mjs';
import { tests, tidy } from './run.mjs';
import './looks.mjs';
import './motion.mjs';
import './controls.mjs';

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
