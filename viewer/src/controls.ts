/** Ties buttons, boxes, slider, pointer and keys to the page's state. */
import type { App } from './app';
import type { ColouringId } from './colour';
import type { CourseRow } from './courses';
import { element, followPointer, option } from './dom';
import { clock, fixed, number, withUnit } from './format';
import { helpHtml, listenToKeys } from './keyboard';
import { connectRange } from './rangeSlider';
import { Readout } from './readout';
import { SidePanel } from './sidePanels';
import { connectTools } from './tools';
import type { Tools } from './tools';

const kSpeeds = [0.1, 0.3, 1, 3, 10, 30, 100];

export interface Controls {
    /** Shows the present state. */
    refresh: () => void;
}

export function connectControls(app: App, rows: CourseRow[]): Controls {
    const colouring = element<HTMLSelectElement>('colouring');
    app.colourings.forEach((c, i) => colouring.append(option(c.id, `${c.label} (${i + 1})`)));
    colouring.addEventListener('change', () => app.setColouring(colouring.value as ColouringId));
    const layer = connectLayers(app);
    connectCamera(app);
    const tools = connectTools(app);
    connectPlayback(app);
    const showRange = connectRange(app);
    const showAxes = connectAxes(app);
    const hoverAgain = followPointer(element('scene'), (at) => app.hover(at));
    connectKeys(app, rows, tools);

    const slider = element<HTMLInputElement>('slider');
    const play = element('play');
    const refresh = (): void => {
        const { from, to } = app.span();
        slider.min = String(from);
        slider.max = String(to);
        slider.value = String(app.moment.time);
        const share = to > from ? (app.moment.time - from) / (to - from) : 0;
        slider.style.setProperty('--share', `${(100 * share).toFixed(2)}%`);
        const { program, block } = app.moment;
        const blocks = program.fibre.time.length - 1;
        const where = app.timeline.programs.length > 1 ? `${program.label} \u00b7 ` : '';
        element('clock').textContent =
            `${clock(app.moment.time - from)} / ${clock(to - from)} \u00b7 ${where}block ${number(block)} of ${number(blocks)}`;
        slider.setAttribute('aria-valuetext', `${fixed(app.moment.time, 1)} seconds, block ${block}`);
        play.classList.toggle('playing', app.playing);
        play.setAttribute('aria-label', app.playing ? 'Pause' : 'Play');
        colouring.value = app.colouring.id;
        layer.value = app.layer === null ? '' : String(app.layer);
        element('with-machine').setAttribute('aria-pressed', String(app.mode() === 'machine'));
        element('on-mandrel').setAttribute('aria-pressed', String(app.mode() === 'mandrel'));
        showRange();
        showAxes();
        hoverAgain();
    };
    return { refresh };
}

function connectLayers(app: App): HTMLSelectElement {
    const layer = element<HTMLSelectElement>('layer');
    layer.append(option('', 'all layers'));
    app.page.layers.forEach((l, i) => {
        const fromReport = app.page.header.report.layers?.[i];
        const kind = fromReport?.kind ?? l.header.kind;
        layer.append(option(String(i), `layer ${i + 1}, ${kind}`));
    });
    element('layer-label').hidden = app.page.layers.length < 2;
    layer.addEventListener('change', () => app.setLayer(layer.value === '' ? null : Number(layer.value)));
    return layer;
}

function connectCamera(app: App): void {
    element('with-machine').addEventListener('click', () => app.setMode('machine'));
    element('on-mandrel').addEventListener('click', () => app.setMode('mandrel'));
    element('fit').addEventListener('click', () => app.parts.stage?.fit());
    const machine = element<HTMLInputElement>('show-machine');
    machine.addEventListener('change', () => app.parts.stage?.showMachine(machine.checked));
    const bare = element<HTMLInputElement>('show-bare');
    bare.addEventListener('change', () => app.setBare(bare.checked));
}

function connectPlayback(app: App): void {
    const toggle = (): void => (app.playing ? app.pause() : app.play());
    element('play').addEventListener('click', toggle);
    const slider = element<HTMLInputElement>('slider');
    slider.addEventListener('input', () => {
        app.pause();
        app.seek(Number(slider.value));
    });
    const speed = element<HTMLSelectElement>('speed');
    for (const s of kSpeeds) speed.append(option(String(s), `${s}\u00d7`));
    speed.value = String(app.speed);
    speed.addEventListener('change', () => {
        app.speed = Number(speed.value);
    });
}

/** \return shows all axes at the clock, and the acceleration of the plotted one */
function connectAxes(app: App): () => void {
    const { plots } = app.parts;
    const { axes } = app.kinematics;
    const readout = new Readout(element('axes'), app.timeline);
    const show = (): void => {
        readout.show(app.moment);
        const { letter, type } = axes[plots.axis];
        const acceleration = withUnit(plots.acceleration(), `${type === 'linear' ? 'mm' : '°'}/s²`);
        element('plot-values').textContent = `${letter}: acceleration ${acceleration}`;
    };
    readout.onChoose = (axis) => {
        plots.setAxis(axis);
        show();
    };
    readout.choose(0);
    element('plot-in').addEventListener('click', () => plots.zoom(1));
    element('plot-out').addEventListener('click', () => plots.zoom(-1));
    element('plot-all').addEventListener('click', () => plots.zoomAll());
    plots.onSeek = (time) => {
        app.pause();
        app.seek(time);
    };
    return show;
}

function connectKeys(app: App, rows: CourseRow[], tools: Tools): void {
    const side = new SidePanel('side');
    const plots = new SidePanel('plots');
    const help = element<HTMLDialogElement>('help');
    element('keys').innerHTML = helpHtml();
    element('help-open').addEventListener('click', () => help.showModal());
    const course = (by: 1 | -1): void => {
        const { from, to } = app.span();
        const now = app.moment.time;
        const own = rows.filter(
            (r) => r.piece.kind === 'course' && (app.layer === null || r.program.fibre.layer === app.layer),
        );
        const later = (r: CourseRow): boolean => r.start > now + 1e-6;
        const earlier = (r: CourseRow): boolean => r.start < now - 1e-6;
        const row = by > 0 ? own.find(later) : own.filter(earlier).pop();
        app.pause();
        app.seek(row ? row.start : by > 0 ? to : from, row?.program);
    };
    listenToKeys({
        playOrPause: () => (app.playing ? app.pause() : app.play()),
        stepBlock: (by) => app.stepBlock(by),
        stepCourse: course,
        toStart: () => {
            app.pause();
            app.seek(app.span().from);
        },
        toEnd: () => {
            app.pause();
            app.seek(app.span().to);
        },
        colouring: (n) => {
            const chosen = app.colourings[n - 1];
            if (chosen) app.setColouring(chosen.id);
        },
        rangeFrom: () => {
            const from = app.range.at(app.moment.time);
            app.setRange(from, Math.max(app.range.last, from));
        },
        rangeTo: () => {
            const to = app.range.at(app.moment.time);
            app.setRange(Math.min(app.range.first, to), to);
        },
        allCourses: () => app.setRange(0, Infinity),
        foldSide: () => side.toggle(),
        foldPlots: () => plots.toggle(),
        section: tools.nextSection,
        measure: tools.toggleMeasure,
        camera: () => app.setMode(app.mode() === 'machine' ? 'mandrel' : 'machine'),
        fit: () => app.parts.stage?.fit(),
        help: () => help.showModal(),
    });
}
