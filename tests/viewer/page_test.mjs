// What report.html shows and does, in a browser:
//   node page_test.mjs REPORT.html [SCREENSHOTS]
// The folder of the page must have the run's motion.csv (and those of further layers and fibres).
import { runTests } from './browser.mjs';
import { tests, tidy } from './run.mjs';
import './looks.mjs';
import './motion.mjs';
import './controls.mjs';
import './panels.mjs';
import './closer.mjs';

await runTests(tests, tidy);
