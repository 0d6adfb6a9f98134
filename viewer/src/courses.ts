/** The plan by course: a table that can be sorted, and whose rows lead to their time. */
import { category, cssColour } from './colour';
import { escapeHtml, fixed, number } from './format';
import type { Program, Timeline } from './timeline';
import type { Piece } from './types';

export interface CourseRow {
    program: Program;
    index: number; // of the piece in its fibre
    piece: Piece;
    start: number; // common clock, s
    duration: number; // s
}

/** All pieces with their times, in winding order. */
export function courseRows(timeline: Timeline): CourseRow[] {
    return timeline.programs.flatMap((program) => {
        const { header, station, time } = program.fibre;
        const starts: number[] = [];
        let block = 0;
        for (const piece of header.pieces) {
            while (block + 1 < station.length && station[block] < piece.first) ++block;
            starts.push(program.start + timeAtStation(station, time, block, piece.first));
        }
        return header.pieces.map((piece, index) => ({
            program,
            index,
            piece,
            start: starts[index],
            duration: Math.max((starts[index + 1] ?? program.end) - starts[index], 0),
        }));
    });
}

function timeAtStation(station: Int32Array, time: Float64Array, block: number, at: number): number {
    if (block === 0) return time[0];
    const [from, to] = [station[block - 1], station[block]];
    if (from < 0 || to <= from) return time[block - 1];
    const share = Math.min(Math.max((at - from) / (to - from), 0), 1);
    return time[block - 1] + share * (time[block] - time[block - 1]);
}

interface Column {
    id: string;
    label: string;
    title: string;
    numeric: boolean;
    value: (row: CourseRow) => number | string;
    text: (row: CourseRow) => string;
}

const kFamily = (n: number) =>
    n < 0 ? '\u2013' : `<i class="swatch" style="background:${cssColour(category(n))}"></i>${n}`;

const kColumns: Column[] = [
    {
        id: 'layer',
        label: 'Layer',
        title: 'Layer',
        numeric: true,
        value: (r) => r.program.fibre.layer,
        text: (r) => String(r.program.fibre.layer + 1),
    },
    {
        id: 'course',
        label: 'Course',
        title: 'Number in winding order',
        numeric: true,
        value: (r) => 1e6 * r.program.index + r.index,
        text: (r) => String(r.piece.course),
    },
    {
        id: 'kind',
        label: 'Kind',
        title: 'Course, or transition between courses',
        numeric: false,
        value: (r) => r.piece.kind,
        text: (r) => escapeHtml(r.piece.kind),
    },
    {
        id: 'family',
        label: 'Family',
        title: 'Family of parallel courses',
        numeric: true,
        value: (r) => r.piece.family,
        text: (r) => kFamily(r.piece.family),
    },
    {
        id: 'length',
        label: 'Length m',
        title: 'Length in metres',
        numeric: true,
        value: (r) => r.piece.length_mm,
        text: (r) => fixed(r.piece.length_mm / 1000, 3),
    },
    {
        id: 'slip',
        label: 'Slip',
        title: 'Worst slip ratio',
        numeric: true,
        value: (r) => r.piece.worst_slip,
        text: (r) => fixed(r.piece.worst_slip, 3),
    },
    {
        id: 'start',
        label: 'From s',
        title: 'Begins at, seconds',
        numeric: true,
        value: (r) => r.start,
        text: (r) => fixed(r.start, 1),
    },
    {
        id: 'time',
        label: 'Time s',
        title: 'Takes so many seconds',
        numeric: true,
        value: (r) => r.duration,
        text: (r) => fixed(r.duration, 2),
    },
];

export class Courses {
    onSeek: (row: CourseRow) => void = () => {};
    private readonly rows: CourseRow[];
    private sortBy = 'course';
    private down = false;
    private layer: number | null = null;
    private elements: HTMLTableRowElement[] = [];
    private current: HTMLElement | null = null;
    private follow = true;

    constructor(
        private readonly host: HTMLElement,
        rows: CourseRow[],
        private readonly slipLimit: number,
        private readonly manyLayers: boolean,
    ) {
        this.rows = rows;
        host.addEventListener('click', (event) =>
            this.click(event.target as HTMLElement, event.detail === 0),
        );
        host.addEventListener('keydown', (event) => {
            const row = (event.target as HTMLElement).closest<HTMLElement>('tr[data-row]');
            if (row && event.key === 'Enter') this.onSeek(this.rows[Number(row.dataset.row)]);
        });
    }

    show(layer: number | null): void {
        this.layer = layer;
        const columns = kColumns.filter((c) => c.id !== 'layer' || (this.manyLayers && layer === null));
        const column = kColumns.find((c) => c.id === this.sortBy) as Column;
        const order = this.rows
            .map((_, i) => i)
            .filter((i) => layer === null || this.rows[i].program.fibre.layer === layer);
        const sign = this.down ? -1 : 1;
        order.sort((a, b) => {
            const [x, y] = [column.value(this.rows[a]), column.value(this.rows[b])];
            return sign * (x < y ? -1 : x > y ? 1 : a - b);
        });
        const head = columns
            .map((c) => {
                const sorted = c.id === this.sortBy;
                const aria = sorted ? (this.down ? 'descending' : 'ascending') : 'none';
                const arrow = sorted ? (this.down ? '\u25be' : '\u25b4') : '';
                return `<th scope="col" aria-sort="${aria}" class="${c.numeric ? 'num' : ''}"><button type="button" data-sort="${c.id}" title="${c.title}">${c.label}<span class="arrow">${arrow}</span></button></th>`;
            })
            .join('');
        const body = order.map((i) => this.rowHtml(i, columns)).join('');
        const length = order.reduce((sum, i) => sum + this.rows[i].piece.length_mm, 0);
        this.host.innerHTML =
            `<p class="muted sum">${order.filter((i) => this.rows[i].piece.kind === 'course').length} courses, ` +
            `${number(length / 1000, 4)}\u202fm of fibre. Choose one to go there.</p>` +
            `<table class="grid courses"><thead><tr>${head}</tr></thead><tbody>${body}</tbody></table>`;
        this.elements = [];
        this.host.querySelectorAll<HTMLTableRowElement>('tr[data-row]').forEach((row) => {
            this.elements[Number(row.dataset.row)] = row;
        });
        this.current = null;
    }

    /** Marks the course under way. */
    mark(program: Program, piece: number): void {
        const index = this.rows.findIndex((r) => r.program === program && r.index === piece);
        const row = this.elements[index] ?? null;
        if (row === this.current) return;
        this.current?.classList.remove('here');
        this.current?.removeAttribute('aria-current');
        row?.classList.add('here');
        row?.setAttribute('aria-current', 'true');
        this.current = row;
        if (row && this.follow && this.host.offsetParent) row.scrollIntoView({ block: 'nearest' });
    }

    private rowHtml(i: number, columns: Column[]): string {
        const row = this.rows[i];
        const cells = columns.map((c) => {
            const over = c.id === 'slip' && row.piece.worst_slip > this.slipLimit * 1.0001;
            return `<td class="${c.numeric ? 'num' : ''}${over ? ' over' : ''}">${c.text(row)}</td>`;
        });
        return `<tr data-row="${i}" tabindex="0" class="${row.piece.kind === 'course' ? '' : 'muted'}">${cells.join('')}</tr>`;
    }

    private click(target: HTMLElement, byKey: boolean): void {
        const sort = target.closest<HTMLElement>('[data-sort]')?.dataset.sort;
        if (sort) {
            this.down =
                sort === this.sortBy ? !this.down : sort === 'slip' || sort === 'time' || sort === 'length';
            this.sortBy = sort;
            this.show(this.layer);
            if (byKey) this.host.querySelector<HTMLElement>(`[data-sort="${sort}"]`)?.focus();
            return;
        }
        const row = target.closest<HTMLElement>('tr[data-row]');
        if (!row) return;
        this.follow = false;
        this.onSeek(this.rows[Number(row.dataset.row)]);
        this.follow = true;
    }
}
