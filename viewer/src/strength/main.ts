/** Opens the page of a wall's strength: what `meshwind strength` found. */
import { box, canDraw, element, followPointer, notice, option } from '../dom';
import { escapeHtml, number } from '../format';
import { Tabs } from '../tabs';
import { ThemeSwitch } from '../theme';
import { colouringsOf, legendHtml } from './colourings';
import type { ColouringId } from './colourings';
import { readWall } from './data';
import type { Wall } from './data';
import { figuresHtml, hoverHtml, layersHtml } from './findings';
import { WallStage } from './stage';

export interface StrengthHook {
    ready: Promise<void>;
    /** What the picture shows, for tests and scripts. */
    state: () => { colours: ColouringId; camera: number[]; target: number[] } | null;
}

declare global {
    interface Window {
        meshwindStrength?: StrengthHook;
    }
}

function fillHead(wall: Wall): void {
    element('title').textContent = wall.header.name;
    document.title = `${wall.header.name} \u2013 strength`;
    element('figures').innerHTML = figuresHtml(wall);
    const reserve = wall.strength.first_failure?.reserve ?? null;
    const verdict = element('verdict');
    verdict.className = `verdict ${reserve !== null && reserve < 1 ? 'bad' : 'ok'}`;
    verdict.textContent =
        reserve === null ? 'No ply' : reserve < 1 ? `A ply fails at ${number(reserve)} of the load` : 'No ply fails';
}

/** Rows lead to places of the wall, and its labels to the rows. */
function connectRows(panel: HTMLElement, stage: WallStage): void {
    const choose = (id: string): void => {
        for (const row of panel.querySelectorAll('.here')) row.classList.remove('here');
        panel.querySelector(`[data-layer="${id.split('-')[1]}"]`)?.classList.add('here');
        stage.labels.choose(id);
    };
    const go = (target: EventTarget | null): void => {
        const row = (target as HTMLElement).closest<HTMLElement>('[data-layer]');
        const label = stage.labels.all().find(({ id }) => id === `layer-${row?.dataset.layer}`);
        if (!label) return;
        choose(label.id);
        stage.flyTo(label);
    };
    stage.labels.onHover = (label) => choose(label?.id ?? '');
    stage.labels.onClick = (label) => stage.flyTo(label);
    panel.addEventListener('click', (event) => go(event.target));
    panel.addEventListener('keydown', (event) => {
        if (event.key === 'Enter') go(event.target);
    });
}

async function open(): Promise<void> {
    const wall = await readWall();
    const tabs = new Tabs(element('tabs'), element('panels'));
    const panel = tabs.add('part', 'Plies');
    panel.innerHTML = layersHtml(wall);
    tabs.add('printed', 'As printed').innerHTML = `<pre class="printed">${escapeHtml(wall.header.text)}</pre>`;
    fillHead(wall);
    const theme = new ThemeSwitch(element('theme'));
    let stage: WallStage | null = null;
    if (canDraw()) stage = new WallStage(wall, element<HTMLCanvasElement>('scene'), element('labels'));
    else notice('This browser has no WebGL 2, so the picture is left out; all that was found is here.');
    const colourings = colouringsOf(wall);
    let colours: ColouringId = 'utilisation';
    const setColours = (id: ColouringId): void => {
        const by = colourings.find((c) => c.id === id) ?? colourings[0];
        colours = by.id;
        stage?.colour(by);
        element('legend').innerHTML = legendHtml(by);
    };
    const select = element<HTMLSelectElement>('colouring');
    for (const { id, label } of colourings) select.append(option(id, label));
    select.addEventListener('change', () => setColours(select.value as ColouringId));
    box('cut', 'c', (on) => stage?.cutOpen(on));
    box('triangles', 't', (on) => stage?.showTriangles(on));
    box('marks', 'm', (on) => stage?.showMarks(on));
    element('marks').title = 'Weakest places (M)';
    element('fit').addEventListener('click', () => stage?.fit());
    window.addEventListener('keydown', (event) => {
        if (event.key === 'f' && !event.ctrlKey && !event.metaKey) stage?.fit();
    });
    const hover = element('hover');
    followPointer(element('scene'), (at) => {
        const face = at && stage ? stage.pick(at) : null;
        hover.hidden = face === null;
        if (face !== null) hover.innerHTML = hoverHtml(wall, face);
    });
    if (stage) connectRows(panel, stage);
    theme.onChange = () => {
        stage?.setTheme();
        stage?.view.render();
    };
    tabs.show('part');
    setColours('utilisation');
    stage?.fit();
    stage?.view.render();
    window.meshwindStrength = {
        ready,
        state: () =>
            stage && {
                colours,
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
