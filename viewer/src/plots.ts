/** Three small plots of one axis over time, linked with the clock. */
import { number, withUnit } from './format';
import type { Motion } from './motion';
import { limitWords, rangeOf, rowsOf, tickStep } from './plotRows';
import type { Row } from './plotRows';
import { upperBlock } from './timeline';
import type { Axis } from './types';

const kLeft = 84;
const kRight = 10;
const kFoot = 18;
const kGap = 7;
const kMinSpan = 0.05; // s
const kPad = 0.08; // of a row's scale, above and below
const kZoomStep = 1.6;

interface Window {
    from: number;
    to: number;
}

export class Plots {
    onSeek: (time: number) => void = () => {};
    axis = 0;
    private whole: Window = { from: 0, to: 1 };
    private window: Window = { from: 0, to: 1 };
    private time = 0;
    private wanted = false;
    private readonly paint: CanvasRenderingContext2D;

    constructor(
        private readonly canvas: HTMLCanvasElement,
        private readonly motion: Motion,
        private readonly axes: Axis[],
    ) {
        this.paint = canvas.getContext('2d') as CanvasRenderingContext2D;
        new ResizeObserver(() => this.request()).observe(canvas);
        canvas.addEventListener('pointerdown', (event) => this.drag(event));
        canvas.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
        canvas.addEventListener('dblclick', () => this.zoomAll());
    }

    setAxis(axis: number): void {
        this.axis = axis;
        this.request();
    }

    /** The stretch of the clock that can be shown; all of it is. */
    setWhole(from: number, to: number): void {
        this.whole = { from, to: Math.max(to, from + kMinSpan) };
        this.zoomAll();
    }

    setTime(time: number): void {
        this.time = time;
        const { from, to } = this.window;
        if (time < from || time > to) {
            const span = to - from;
            this.setWindow(time - (time < from ? 0.8 : 0.2) * span, span);
        }
        this.request();
    }

    zoomAll(): void {
        this.window = { ...this.whole };
        this.request();
    }

    zoom(direction: 1 | -1, around = this.time): void {
        const factor = direction > 0 ? 1 / kZoomStep : kZoomStep;
        const span = (this.window.to - this.window.from) * factor;
        this.setWindow(around - (around - this.window.from) * factor, span);
    }

    /** Of the axis at the clock. */
    acceleration(): number {
        return this.motion.of(this.axis).acceleration[upperBlock(this.motion.time, this.time)];
    }

    request(): void {
        if (this.wanted) return;
        this.wanted = true;
        requestAnimationFrame(() => this.draw());
    }

    private setWindow(from: number, span: number): void {
        const { whole } = this;
        const length = Math.min(Math.max(span, kMinSpan), whole.to - whole.from);
        const start = Math.min(Math.max(from, whole.from), whole.to - length);
        this.window = { from: start, to: start + length };
        this.request();
    }

    private timeAt(x: number): number {
        const { from, to } = this.window;
        const width = this.canvas.clientWidth - kLeft - kRight;
        return from + ((x - kLeft) / width) * (to - from);
    }

    private xOf(time: number): number {
        const { from, to } = this.window;
        return kLeft + ((time - from) / (to - from)) * (this.canvas.clientWidth - kLeft - kRight);
    }

    private drag(event: PointerEvent): void {
        if (event.button !== 0) return;
        this.canvas.setPointerCapture(event.pointerId);
        const { from, to } = this.window;
        const seek = (e: PointerEvent): void =>
            this.onSeek(Math.min(Math.max(this.timeAt(e.offsetX), from), to));
        const end = (): void => this.canvas.removeEventListener('pointermove', seek);
        seek(event);
        this.canvas.addEventListener('pointermove', seek);
        this.canvas.addEventListener('pointerup', end, { once: true });
        this.canvas.addEventListener('pointercancel', end, { once: true });
    }

    private wheel(event: WheelEvent): void {
        event.preventDefault();
        const span = this.window.to - this.window.from;
        if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY)) {
            const move = (event.deltaX || event.deltaY) / this.canvas.clientWidth;
            this.setWindow(this.window.from + move * span, span);
        } else {
            this.zoom(event.deltaY < 0 ? 1 : -1, this.timeAt(event.offsetX));
        }
    }

    private draw(): void {
        this.wanted = false;
        const { canvas, paint } = this;
        const { clientWidth: width, clientHeight: height } = canvas;
        if (!width || !height) return;
        const ratio = window.devicePixelRatio || 1;
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
        paint.setTransform(ratio, 0, 0, ratio, 0, 0);
        paint.clearRect(0, 0, width, height);
        const style = getComputedStyle(canvas);
        const colour = (name: string) => style.getPropertyValue(name).trim();
        paint.font = `11px ${style.fontFamily}`;
        const rows = rowsOf(this.axes[this.axis], this.motion.of(this.axis));
        const rowHeight = (height - kFoot - 4) / rows.length;
        rows.forEach((row, i) => this.drawRow(row, 4 + i * rowHeight, rowHeight - kGap, colour));
        this.drawClock(height, colour);
    }

    private drawRow(row: Row, top: number, height: number, colour: (n: string) => string) {
        const { paint } = this;
        const right = this.canvas.clientWidth - kRight;
        const [first, last] = this.entries();
        const [bottom, peak] = rangeOf(row, first, last);
        const pad = kPad * (peak - bottom);
        const [low, high] = [row.about === 'above-zero' ? 0 : bottom - pad, peak + pad];
        const yOf = (v: number) => top + height - ((v - low) / (high - low)) * height;
        paint.fillStyle = colour('--plot-ground');
        paint.fillRect(kLeft, top, right - kLeft, height);
        paint.fillStyle = colour('--muted');
        paint.textAlign = 'right';
        paint.textBaseline = 'middle';
        paint.fillText(number(Number(peak.toPrecision(4)), 4), kLeft - 6, yOf(peak) + 1);
        paint.fillText(number(Number(bottom.toPrecision(4)), 4), kLeft - 6, yOf(bottom));
        if (low < 0 && high > 0) this.level(yOf(0), colour('--line'), []);
        for (const limit of [row.low, row.high]) {
            if (limit === null || limit < low || limit > high) continue;
            this.level(yOf(limit), colour('--limit'), [5, 4]);
        }
        paint.save();
        paint.beginPath();
        paint.rect(kLeft, top - 1, right - kLeft, height + 2);
        paint.clip();
        paint.strokeStyle = colour('--accent');
        paint.lineWidth = 1.3;
        paint.beginPath();
        this.trace(row, first, last, yOf);
        paint.stroke();
        paint.restore();
        this.drawNames(row, top, height, colour);
    }

    private drawNames(row: Row, top: number, height: number, colour: (n: string) => string): void {
        const { paint } = this;
        paint.textAlign = 'left';
        paint.textBaseline = 'middle';
        paint.fillStyle = colour('--text');
        paint.fillText(row.label, 5, top + height / 2 - 6);
        paint.fillStyle = colour('--muted');
        paint.fillText(row.unit, 5, top + height / 2 + 7);
        const words = limitWords(row);
        if (!words) return;
        const right = this.canvas.clientWidth - kRight;
        const width = paint.measureText(words).width;
        paint.globalAlpha = 0.8;
        paint.fillStyle = colour('--plot-ground');
        paint.fillRect(right - width - 9, top, width + 9, 15);
        paint.globalAlpha = 1;
        paint.fillStyle = colour('--limit');
        paint.textAlign = 'right';
        paint.fillText(words, right - 4, top + 8);
    }

    private level(y: number, colour: string, dash: number[]): void {
        const { paint } = this;
        paint.strokeStyle = colour;
        paint.lineWidth = 1;
        paint.setLineDash(dash);
        paint.beginPath();
        paint.moveTo(kLeft, Math.round(y) + 0.5);
        paint.lineTo(this.canvas.clientWidth - kRight, Math.round(y) + 0.5);
        paint.stroke();
        paint.setLineDash([]);
    }

    /** Entries of the motion that touch the window. */
    private entries(): [number, number] {
        const { time } = this.motion;
        const first = Math.max(upperBlock(time, this.window.from) - 1, 0);
        return [first, Math.min(upperBlock(time, this.window.to) + 1, time.length - 1)];
    }

    private trace(row: Row, first: number, last: number, yOf: (v: number) => number): void {
        const width = this.canvas.clientWidth - kLeft - kRight;
        if (last - first > 3 * width) this.traceColumns(row, first, last, yOf);
        else this.traceExact(row, first, last, yOf);
    }

    private traceExact(row: Row, first: number, last: number, yOf: (v: number) => number): void {
        const { paint, motion } = this;
        const { time } = motion;
        const starts = new Set(motion.first);
        let down = false;
        const to = (x: number, y: number): void => {
            if (down) paint.lineTo(x, y);
            else paint.moveTo(x, y);
            down = true;
        };
        for (let i = first; i <= last; ++i) {
            const v = row.values[i];
            if (starts.has(i) || Number.isNaN(v)) down = false;
            if (Number.isNaN(v)) continue;
            const y = yOf(v);
            if (row.steps === 'line') to(this.xOf(time[i]), y);
            else {
                to(this.xOf(time[i - 1] ?? time[i]), y);
                to(this.xOf(time[i]), y);
            }
        }
    }

    /** Least and largest value in each column of pixels, where there are many blocks to one. */
    private traceColumns(row: Row, first: number, last: number, yOf: (v: number) => number): void {
        const { paint, motion } = this;
        const starts = new Set(motion.first);
        let column = NaN;
        let low = Infinity;
        let high = -Infinity;
        let before = NaN; // value of the entry before
        const flush = (): void => {
            if (low > high) return;
            paint.moveTo(column + 0.5, yOf(low) + 0.5);
            paint.lineTo(column + 0.5, yOf(high) - 0.5);
        };
        for (let i = first; i <= last; ++i) {
            const v = row.values[i];
            if (starts.has(i)) before = NaN;
            if (Number.isNaN(v)) continue;
            const x = Math.floor(this.xOf(motion.time[i]));
            if (x !== column) {
                flush();
                if (x > column + 1) {
                    // A block that is wider than a column.
                    const from = row.steps === 'line' ? before : v;
                    paint.moveTo(column + 0.5, yOf(Number.isNaN(from) ? v : from));
                    paint.lineTo(x + 0.5, yOf(v));
                }
                column = x;
                low = Infinity;
                high = -Infinity;
            }
            low = Math.min(low, v);
            high = Math.max(high, v);
            before = v;
        }
        flush();
    }

    private drawClock(height: number, colour: (n: string) => string): void {
        const { paint } = this;
        const { from, to } = this.window;
        paint.fillStyle = colour('--muted');
        paint.textBaseline = 'bottom';
        const step = tickStep(to - from, (this.canvas.clientWidth - kLeft) / 90);
        for (let t = Math.ceil(from / step) * step; t <= to + 1e-9; t += step) {
            const x = this.xOf(t);
            paint.textAlign = x > this.canvas.clientWidth - 40 ? 'right' : 'center';
            paint.fillText(withUnit(Number(t.toFixed(6)), 's', 6), x, height);
        }
        const x = Math.round(this.xOf(this.time)) + 0.5;
        paint.strokeStyle = colour('--cursor');
        paint.lineWidth = 1.5;
        paint.beginPath();
        paint.moveTo(x, 2);
        paint.lineTo(x, height - kFoot + 2);
        paint.stroke();
    }
}
