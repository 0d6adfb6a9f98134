/** Section, measuring and travel: what one looks closer with. */
import { Vector2 } from 'three';
import type { App } from './app';
import { element, option } from './dom';
import { fixed } from './format';
import { measuredHtml } from './measure';
import type { SectionAxis } from './section';
import type { Stage } from './stage';

const kAxes: SectionAxis[] = ['x', 'y', 'z'];
const kClickPx = 4; // a pointer that moves farther drags

export interface Tools {
    nextSection: () => void;
    toggleMeasure: () => void;
}

export function connectTools(app: App): Tools {
    const { stage } = app.parts;
    if (!stage) return { nextSection: () => {}, toggleMeasure: () => {} };
    connectTravel(stage);
    return { nextSection: connectSection(stage), toggleMeasure: connectMeasure(stage) };
}

function connectTravel(stage: Stage): void {
    element('travel-label').hidden = stage.travel.isEmpty();
    const tick = element<HTMLInputElement>('show-travel');
    tick.addEventListener('change', () => {
        stage.travel.lines.visible = tick.checked;
        stage.view.request();
    });
}

/** \return goes on to the next axis */
function connectSection(stage: Stage): () => void {
    const { section } = stage;
    const choice = element<HTMLSelectElement>('section');
    const slider = element<HTMLInputElement>('section-at');
    choice.append(option('', 'none'), ...kAxes.map((axis) => option(axis, axis)));
    const show = (): void => {
        const { from, to, at } = section.travel();
        element('section-bar').hidden = section.axis === null;
        slider.min = String(from);
        slider.max = String(to);
        slider.value = String(at);
        element('section-words').textContent = section.axis ? `${section.axis} = ${fixed(at, 1)} mm` : '';
        stage.placeSection();
    };
    const choose = (axis: string): void => {
        choice.value = axis;
        section.choose(kAxes.find((a) => a === axis) ?? null);
        show();
    };
    choice.addEventListener('change', () => choose(choice.value));
    slider.addEventListener('input', () => {
        section.moveTo(Number(slider.value));
        show();
    });
    return () => {
        const order = ['', ...kAxes];
        choose(order[(order.indexOf(choice.value) + 1) % order.length]);
    };
}

/** \return begins or ends it */
function connectMeasure(stage: Stage): () => void {
    const { measure, view } = stage;
    const button = element('measure');
    const words = element('measured');
    const show = (): void => {
        button.setAttribute('aria-pressed', String(measure.on));
        view.canvas.parentElement?.classList.toggle('measuring', measure.on);
        words.hidden = !measure.on;
        words.innerHTML = measuredHtml(measure.places);
        view.request();
    };
    const toggle = (): void => {
        measure.turn(!measure.on);
        show();
    };
    button.addEventListener('click', toggle);
    let pressed: Vector2 | null = null;
    view.canvas.addEventListener('pointerdown', (event) => {
        pressed = event.button === 0 ? new Vector2(event.clientX, event.clientY) : null;
    });
    view.canvas.addEventListener('pointerup', (event) => {
        const still = pressed && pressed.distanceTo(new Vector2(event.clientX, event.clientY)) < kClickPx;
        pressed = null;
        if (!measure.on || !still) return;
        const box = view.canvas.getBoundingClientRect();
        const hit = stage.pick(
            new Vector2(
                ((event.clientX - box.left) / box.width) * 2 - 1,
                1 - ((event.clientY - box.top) / box.height) * 2,
            ),
        );
        if (!hit) return;
        measure.take(hit.place);
        show();
    });
    return toggle;
}
