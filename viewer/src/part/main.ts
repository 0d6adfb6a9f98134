/** Opens the page of a part: what `meshwind inspect` understood of a file. */
import { box, canDraw, element, followPointer, notice, option } from '../dom';
import { escapeHtml } from '../format';
import { Tabs } from '../tabs';
import { ThemeSwitch } from '../theme';
import { readPart } from './data';
import type { Part } from './data';
import { figuresHtml, findingsHtml, hoverHtml, legendHtml, regionRowsHtml } from './findings';
import type { Colours } from './kinds';
import type { Label } from './labels';
import { PartStage } from './stage';

export interface PartHook {
    ready: Promise<void>;
    /** What the picture shows, for tests and scripts. */
    state: () => { colours: Colours; cut: boolean; camera: number[]; target: number[] } | null;
}

declare global {
    interface Window {
        meshwindPart?: PartHook;
    }
}

function fillHead(part: Part): void {
    const { file, remarks } = part.inspected;
    element('title').textContent = file;
    document.title = `${file} \u2013 part`;
    element('figures').innerHTML = figuresHtml(part);
    const { refused } = part.header;
    const verdict = element('verdict');
    verdict.className = `verdict ${refused ? 'bad' : 'ok'}`;
    const count = remarks.length === 1 ? '1 remark' : `${remarks.length} remarks`;
    verdict.textContent = refused ? 'The main job refuses it' : `Can be planned, ${count}`;
}

/** Rows of the lists lead to places of the part, and its labels to the rows. */
function connectLists(panel: HTMLElement, stage: PartStage | null): void {
    const rowOf = (label: Label | null): Element | null => {
        if (!label || label.kind === 'spindle') return null;
        return panel.querySelector(`[data-${label.kind}="${label.id.split('-')[1]}"]`);
    };
    const choose = (label: Label | null): void => {
        for (const row of panel.querySelectorAll('.here')) row.classList.remove('here');
        rowOf(label)?.classList.add('here');
        stage?.labels.choose(label?.id ?? '');
    };
    if (!stage) return;
    stage.labels.onHover = (label) => choose(label);
    stage.labels.onClick = (label) => {
        choose(label);
        rowOf(label)?.scrollIntoView({ block: 'nearest' });
        stage.flyTo(label);
    };
    const visits = new Map<string, number>(); // of places, so that a row leads to one after the other
    const go = (target: EventTarget | null): void => {
        const row = (target as HTMLElement).closest<HTMLElement>('[data-remark], [data-rim]');
        if (!row) return;
        const id = row.dataset.rim === undefined ? `remark-${row.dataset.remark}` : `rim-${row.dataset.rim}`;
        const own = stage.labels.all().filter((label) => label.id === id);
        if (!own.length) return;
        const visit = visits.get(id) ?? 0;
        visits.set(id, visit + 1);
        choose(own[0]);
        stage.flyTo(own[visit % own.length]);
    };
    panel.addEventListener('click', (event) => go(event.target));
    panel.addEventListener('keydown', (event) => {
        if (event.key === 'Enter') go(event.target);
    });
    panel.addEventListener('pointerover', (event) => {
        const row = (event.target as HTMLElement).closest<HTMLElement>('[data-region]');
        stage.choose(row ? Number(row.dataset.region) : null);
        const axis = (event.target as HTMLElement).closest<HTMLElement>('[data-axis]');
        stage.showAxis(axis ? Number(axis.dataset.axis) : null);
    });
    panel.addEventListener('pointerleave', () => {
        stage.choose(null);
        stage.showAxis(null);
    });
}

async function open(): Promise<void> {
    const part = await readPart();
    const tabs = new Tabs(element('tabs'), element('panels'));
    const panel = tabs.add('part', 'Part');
    panel.innerHTML = findingsHtml(part);
    tabs.add('printed', 'As printed').innerHTML = `<pre class="printed">${escapeHtml(part.header.text)}</pre>`;
    fillHead(part);
    const theme = new ThemeSwitch(element('theme'));
    let stage: PartStage | null = null;
    if (canDraw()) stage = new PartStage(part, element<HTMLCanvasElement>('scene'), element('labels'));
    else notice('This browser has no WebGL 2, so the picture is left out; all that was found is here.');
    let colours: Colours = 'kind';
    const setColours = (by: Colours): void => {
        colours = by;
        stage?.colour(by);
        element('legend').innerHTML = legendHtml(part, by);
        const body = panel.querySelector('.regions tbody');
        if (body) body.innerHTML = regionRowsHtml(part, by);
    };
    const select = element<HTMLSelectElement>('colouring');
    select.append(option('kind', 'What it is'), option('region', 'Region'));
    select.addEventListener('change', () => setColours(select.value as Colours));
    box('cut', 'c', (on) => stage?.cutOpen(on));
    box('triangles', 't', (on) => stage?.showTriangles(on));
    box('marks', 'm', (on) => stage?.showMarks(on));
    element('fit').addEventListener('click', () => stage?.fit());
    window.addEventListener('keydown', (event) => {
        if (event.key === 'f' && !event.ctrlKey && !event.metaKey) stage?.fit();
    });
    const hover = element('hover');
    followPointer(element('scene'), (at) => {
        const hit = at && stage ? stage.pick(at) : null;
        hover.hidden = !hit;
        if (hit) hover.innerHTML = hoverHtml(part, hit);
    });
    connectLists(panel, stage);
    theme.onChange = () => {
        stage?.setTheme();
        stage?.view.render();
    };
    tabs.show('part');
    setColours('kind');
    stage?.fit();
    stage?.view.render();
    window.meshwindPart = {
        ready,
        state: () =>
            stage && {
                colours,
                cut: stage.body.isCut(),
                camera: stage.view.camera.position.toArray(),
                target: stage.view.controls.target.toArray(),
            },
    };
}

const ready: Promise<void> = open().then(
    () => document.body.classList.add('ready'),
    (error: unknown) => {
        notice(error instanceof Error ? error.message : String(error));
        document.body.classList.add('failed');
        throw error;
    },
);
