/** Opens the page: reads its data, builds the parts and ties them to the controls. */
import { App } from './app';
import { Checks } from './checks';
import { connectControls } from './controls';
import { CourseRange } from './courseRange';
import { courseRows, Courses } from './courses';
import { readPage } from './data';
import type { Page } from './data';
import { canDraw, element, notice } from './dom';
import { escapeHtml } from './format';
import { jobHtml } from './jobSheet';
import { Kinematics } from './kinematics';
import { followLink, LinkKeeper, stateOf } from './link';
import { Listing } from './listing';
import { Motion } from './motion';
import { Plots } from './plots';
import { Stage } from './stage';
import { bareHtml, figuresHtml, layersHtml } from './tables';
import { Tabs } from './tabs';
import { ThemeSwitch } from './theme';
import { Timeline } from './timeline';

/** The picture, or null with one line that says why there is none. */
function openStage(
    page: Page,
    kinematics: Kinematics,
    timeline: Timeline,
    range: CourseRange,
): Stage | null {
    const canvas = element<HTMLCanvasElement>('scene');
    if (canDraw()) return new Stage(page, kinematics, timeline, range, canvas);
    notice(
        'This browser has no WebGL 2, so the picture is left out; checks, tables, plots and program are complete.',
    );
    return null;
}

function fillHead(page: Page, duration: number, checks: Checks): void {
    const { report } = page.header;
    const file = report.mandrel?.file ?? 'Winding';
    element('title').textContent = file;
    document.title = `${file} \u2013 winding report`;
    element('figures').innerHTML = figuresHtml(report, duration);
    const failed = checks.failed().length;
    const ok = failed === 0 && report.ok !== false;
    const verdict = element('verdict');
    verdict.className = `verdict ${ok ? 'ok' : 'bad'}`;
    verdict.textContent = ok
        ? `All ${checks.count()} checks passed`
        : failed
          ? `${failed} of ${checks.count()} checks failed`
          : 'Not ready to be wound';
}

async function open(): Promise<void> {
    const page = await readPage();
    const { report, check_kinds: kinds, machine, tow } = page.header;
    const kinematics = new Kinematics(machine);
    const timeline = new Timeline(page, kinematics.axes);
    const layered = page.layers.length > 1;

    const tabs = new Tabs(element('tabs'), element('panels'));
    const checks = new Checks(tabs.add('checks', 'Checks'), report, kinds, page.layers.length);
    const rows = courseRows(timeline);
    const courses = new Courses(tabs.add('courses', 'Courses'), rows, tow.friction, layered);
    const layersPanel = tabs.add('layers', 'Layers');
    layersPanel.innerHTML = layersHtml(report, page.layers[0].header.kind);
    const bare = tabs.add('bare', 'Coverage');
    if (report.run) tabs.add('job', 'Job').innerHTML = jobHtml(report.run);
    const programPanel = tabs.add('program', 'Program');
    programPanel.innerHTML = '<p class="muted sum"></p><div></div>';
    const listing = new Listing(
        programPanel.children[1] as HTMLElement,
        programPanel.children[0] as HTMLElement,
    );
    const plots = new Plots(element<HTMLCanvasElement>('plot'), new Motion(timeline), kinematics.axes);
    const theme = new ThemeSwitch(element('theme'));
    const range = new CourseRange(rows);
    const stage = openStage(page, kinematics, timeline, range);
    fillHead(page, timeline.duration, checks);

    const app = new App(page, timeline, kinematics, range, {
        stage,
        checks,
        courses,
        listing,
        plots,
        legend: element('legend'),
        hover: element('hover'),
    });
    const controls = connectControls(app, rows);
    const keeper = new LinkKeeper(app);
    app.onChange = () => {
        controls.refresh();
        keeper.note();
    };
    app.onLayer = () => {
        bare.innerHTML = bareHtml(report, app.layer);
    };
    checks.onPlace = (place) => app.showPlace(place);
    courses.onSeek = (row) => {
        app.pause();
        app.seek(row.start, row.program);
    };
    listing.onSeek = (program, block) => app.seekBlock(program, block);
    layersPanel.addEventListener('click', (event) => {
        const row = (event.target as HTMLElement).closest<HTMLElement>('[data-layer]');
        if (row) app.setLayer(Number(row.dataset.layer));
    });
    theme.onChange = () => {
        stage?.setTheme();
        stage?.view.render();
        plots.request();
    };

    tabs.show('checks');
    app.setLayer(null);
    stage?.fit();
    followLink(app);
    window.meshwind = {
        ready,
        seek: (seconds) => {
            app.pause();
            app.seek(seconds);
        },
        state: () => stateOf(app),
    };
    stage?.view.render();
}

const ready: Promise<void> = open().then(
    () => document.body.classList.add('ready'),
    (error: unknown) => {
        const words = error instanceof Error ? error.message : String(error);
        notice(words);
        element('title').innerHTML = escapeHtml('Winding report');
        document.body.classList.add('failed');
        throw error;
    },
);
