/** The double slider that says which courses are drawn. */
import type { App } from './app';
import { element } from './dom';

/** \return shows the present range */
export function connectRange(app: App): () => void {
    const { range } = app;
    const first = element<HTMLInputElement>('first-course');
    const last = element<HTMLInputElement>('last-course');
    const bar = element<HTMLFieldSetElement>('range');
    const words = element('range-words');
    const all = element<HTMLButtonElement>('all-courses');
    first.addEventListener('input', () => app.setRange(Math.min(Number(first.value), range.last), range.last));
    last.addEventListener('input', () => app.setRange(range.first, Math.max(Number(last.value), range.first)));
    all.addEventListener('click', () => app.setRange(0, Infinity));

    const several = app.page.layers.length > 1;
    const nameOf = (index: number): string => {
        const row = range.courses[index];
        const layer = several && app.layer === null ? `layer ${row.program.fibre.layer + 1}: ` : '';
        return `${layer}${row.piece.course}`;
    };
    let shown = '';
    return () => {
        const { courses } = range;
        bar.hidden = courses.length < 2;
        const state = [app.layer, range.first, range.last, app.colouring.perFace !== null].join();
        if (bar.hidden || state === shown) return;
        shown = state;
        // Where faces are coloured no band is drawn.
        bar.disabled = app.colouring.perFace !== null;
        const end = courses.length - 1;
        for (const [input, index] of [[first, range.first], [last, range.last]] as const) {
            input.max = String(end);
            input.value = String(index);
            input.setAttribute('aria-valuetext', `course ${nameOf(index)}`);
        }
        // Where both are at the upper end the first one can be moved.
        first.classList.toggle('upper', range.first > end / 2);
        bar.style.setProperty('--from', String(range.first / end));
        bar.style.setProperty('--to', String(range.last / end));
        const count = range.last - range.first + 1;
        words.textContent = `${nameOf(range.first)} to ${nameOf(range.last)} \u00b7 ${count} of ${courses.length}`;
        all.disabled = bar.disabled || range.isWhole();
    };
}
