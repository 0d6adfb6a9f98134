/** Where all axes are and how fast: one row each, the one that is plotted marked. */
import { escapeHtml, fixed, number } from './format';
import { speedsAt } from './timeline';
import type { Moment, Timeline } from './timeline';
import type { Axis } from './types';

interface Row {
    axis: Axis;
    button: HTMLButtonElement;
    position: Text;
    speed: Text;
    turns: Text | null; // of an axis without ends
    mark: HTMLElement | null; // of one with ends
}

export class Readout {
    onChoose: (axis: number) => void = () => {};
    private readonly rows: Row[];

    /** \param host body of the table */
    constructor(host: HTMLElement, timeline: Timeline) {
        const { axes } = timeline;
        host.innerHTML = axes.map((axis, i) => rowHtml(axis, travelOf(timeline, i))).join('');
        this.rows = [...host.querySelectorAll('tr')].map((row, i) => ({
            axis: axes[i],
            button: row.querySelector('button') as HTMLButtonElement,
            position: textOf(row.cells[1]),
            speed: textOf(row.cells[2]),
            turns: hasEnds(axes[i]) ? null : textOf(row.cells[3]),
            mark: row.querySelector<HTMLElement>('.travel b'),
        }));
        this.rows.forEach(({ button }, i) => button.addEventListener('click', () => this.choose(i)));
    }

    choose(axis: number): void {
        this.rows.forEach(({ button }, i) => button.setAttribute('aria-pressed', String(i === axis)));
        this.onChoose(axis);
    }

    show(moment: Moment): void {
        const speeds = speedsAt(moment);
        this.rows.forEach(({ axis, position, speed, turns, mark }, i) => {
            const at = moment.axes[i];
            const unit = unitOf(axis);
            write(position, `${fixed(at, 3)}${unit}`);
            write(speed, `${fixed(speeds[i], 1)}\u202f${unit.trim()}/s`);
            if (turns) write(turns, axis.type === 'rotary' ? `${fixed(at / 360, 2)} turns` : '');
            if (mark) mark.style.transform = `translateX(${(100 * shareOf(axis, at)).toFixed(2)}%)`;
        });
    }
}

function unitOf(axis: Axis): string {
    return axis.type === 'linear' ? '\u202fmm' : '°';
}

function hasEnds(axis: Axis): boolean {
    return axis.min !== null && axis.max !== null && axis.max > axis.min;
}

/** Of the travel from end to end, 0..1. */
function shareOf({ min, max }: Axis, at: number): number {
    const [low, high] = [min as number, max as number];
    return Math.min(Math.max((at - low) / (high - low), 0), 1);
}

/** Least and largest value of an axis in all programs. */
function travelOf({ programs, axes }: Timeline, axis: number): [number, number] {
    let [low, high] = [Infinity, -Infinity];
    for (const { fibre } of programs) {
        for (let i = axis; i < fibre.axes.length; i += axes.length) {
            low = Math.min(low, fibre.axes[i]);
            high = Math.max(high, fibre.axes[i]);
        }
    }
    return low > high ? [0, 0] : [low, high];
}

function rowHtml(axis: Axis, [low, high]: [number, number]): string {
    const letter = escapeHtml(axis.letter);
    const range = (a: number, b: number): string => `${number(a, 6)} to ${number(b, 6)}${unitOf(axis)}`;
    let last = '<td class="num muted"></td>';
    if (hasEnds(axis)) {
        const [left, right] = [shareOf(axis, low), shareOf(axis, high)].map((s) => (100 * s).toFixed(1));
        const ends = `travel ${range(axis.min as number, axis.max as number)}, used ${range(low, high)}`;
        last =
            `<td title="${ends}"><span class="travel" role="img" aria-label="${ends}">` +
            `<i style="left:${left}%;right:calc(100% - ${right}%)"></i><b></b></span></td>`;
    }
    return (
        `<tr><th scope="row"><button type="button" title="Plot axis ${letter}, ${axis.type}" aria-label="Plot axis ${letter}" ` +
        `aria-pressed="false">${letter}</button></th><td class="num"></td><td class="num"></td>${last}</tr>`
    );
}

function textOf(cell: HTMLElement): Text {
    return cell.appendChild(document.createTextNode(''));
}

function write(text: Text, words: string): void {
    if (text.data !== words) text.data = words;
}
