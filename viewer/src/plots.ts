/** Three small plots of one axis over time, linked with the clock. */
import { number, withUnit } from './format';
import type { AxisMotion, Motion } from './motion';
import { upperBlock } from './timeline';
import type { Axis } from './types';

const kLeft = 58;
const kRight = 10;
const kFoot = 18;
const kGap = 7;
const kLeastSpan = 0.05; // s
const kZoomStep = 1.6;
/** A limit farther off than so many times the data's size is named, not drawn. */
const kFarLimit = 2.5;

interface Row {
    label: string;
    unit: string;
    values: Float64Array;
    steps: 'line' | 'block' | 'joint';
    low: number | null; // limits
    high: number | null;
}

interface Window {
    from: number;
    to: number;
}

export class Plots {
    onSeek: (time: number) => void = () => {};
    private axis = 0;
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
        this.whole = { from, to: Math.max(to, from + kLeastSpan) };
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

    /** Speed and acceleration of the axis at the clock, in words. */
    values(): { position: number; speed: number; acceleration: number } {
        const motion = this.motion.of(this.axis);
        const entry = upperBlock(this.motion.time, this.time);
        return {
            position: motion.position[entry],
            speed: motion.speed[entry],
            acceleration: motion.acceleration[entry],
        };
    }

    request(): void {
        if (this.wanted) return;
        this.wanted = true;
        requestAnimationFrame(() => this.draw());
    }

    private setWindow(from: number, span: number): void {
        const { whole } = this;
        const length = Math.min(Math.max(span, kLeastSpan), whole.to - whole.from);
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

    private rows(): Row[] {
        const axis = this.axes[this.axis];
        const motion: AxisMotion = this.motion.of(this.axis);
        const unit = axis.type === 'linear' ? 'mm' : '°';
        const both = (limit: number | null) => ({
            low: limit === null ? null : -limit,
            high: limit,
        });
        return [
            { label: 'Position', unit, values: motion.position, steps: 'line', low: axis.min, high: axis.max },
            { label: 'Speed', unit: `${unit}/s`, values: motion.speed, steps: 'block', ...both(axis.velocity) },
            { label: 'Accel.', unit: `${unit}/s²`, values: motion.acceleration, steps: 'joint', ...both(axis.acceleration) },
        ];
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
        const rows = this.rows();
        const rowHeight = (height - kFoot - 4) / rows.length;
        rows.forEach((row, i) =>
            this.drawRow(row, 4 + i * rowHeight, rowHeight - kGap, i === 0 ? 2 : 0, colour),
        );
        this.drawClock(height, colour);
    }

    private drawRow(row: Row, top: number, height: number, _inset: number, colour: (n: string) => string) {
        const { paint } = this;
        const right = this.canvas.clientWidth - kRight;
        const [first, last] = this.entries();
        const [low, high, off] = rangeOf(row, first, last);
        const yOf = (v: number) => top + height - ((v - low) / (high - low)) * height;
        paint.fillStyle = colour('--plot-ground');
        paint.fillRect(kLeft, top, right - kLeft, height);
        paint.fillStyle = colour('--muted');
        paint.textAlign = 'right';
        paint.textBaseline = 'top';
        paint.fillText(number(high, 3), kLeft - 6, top - 1);
        paint.textBaseline = 'bottom';
        paint.fillText(number(low, 3), kLeft - 6, top + height + 2);
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
        paint.fillStyle = colour('--text');
        paint.textAlign = 'left';
        paint.textBaseline = 'top';
        const title = `${row.label}, ${row.unit}`;
        const room = paint.measureText(title + (off ? `   ${off}` : '')).width;
        paint.globalAlpha = 0.82;
        paint.fillStyle = colour('--plot-ground');
        paint.fillRect(kLeft + 3, top + 1, room + 8, 14);
        paint.globalAlpha = 1;
        paint.fillStyle = colour('--text');
        paint.fillText(title, kLeft + 6, top + 2);
        if (!off) return;
        paint.fillStyle = colour('--limit');
        paint.fillText(off, kLeft + 6 + paint.measureText(`${title}   `).width, top + 2);
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
            else if (row.steps === 'block') {
                to(this.xOf(time[i - 1] ?? time[i]), y);
                to(this.xOf(time[i]), y);
            } else {
                to(this.xOf((time[i - 1] + time[i]) / 2), y);
                to(this.xOf((time[i] + time[i + 1]) / 2), y);
            }
        }
    }

    /** Least and largest value in each column of pixels, where there are many blocks to one. */
    private traceColumns(row: Row, first: number, last: number, yOf: (v: number) => number): void {
        const { paint, motion } = this;
        let column = NaN;
        let low = Infinity;
        let high = -Infinity;
        const flush = (): void => {
            if (low > high) return;
            paint.moveTo(column + 0.5, yOf(low) + 0.5);
            paint.lineTo(column + 0.5, yOf(high) - 0.5);
        };
        for (let i = first; i <= last; ++i) {
            const v = row.values[i];
            if (Number.isNaN(v)) continue;
            const x = Math.floor(this.xOf(motion.time[i]));
            if (x !== column) {
                flush();
                column = x;
                low = Infinity;
                high = -Infinity;
            }
            low = Math.min(low, v);
            high = Math.max(high, v);
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

function tickStep(span: number, ticks: number): number {
    const rough = span / Math.max(ticks, 1);
    const power = 10 ** Math.floor(Math.log10(rough));
    return power * ([1, 2, 5, 10].find((f) => f * power >= rough) ?? 10);
}

/** Lower and upper end of a row, and the limit in words where it is too far off to be drawn. */
function rangeOf(row: Row, first: number, last: number): [number, number, string] {
    let low = Infinity;
    let high = -Infinity;
    for (let i = first; i <= last; ++i) {
        const v = row.values[i];
        if (Number.isNaN(v)) continue;
        low = Math.min(low, v);
        high = Math.max(high, v);
    }
    if (low > high) [low, high] = [0, 1];
    if (row.steps !== 'line') {
        high = Math.max(Math.abs(low), Math.abs(high));
        low = -high;
    }
    if (high - low < 1e-9) [low, high] = [low - 0.5, high + 0.5];
    const [bottom, top] = [low, high];
    const near = (limit: number) => Math.abs(limit - (top + bottom) / 2) <= (kFarLimit * (top - bottom)) / 2;
    const far: number[] = [];
    for (const limit of [row.low, row.high]) {
        if (limit === null) continue;
        if (near(limit)) {
            low = Math.min(low, limit);
            high = Math.max(high, limit);
        } else far.push(limit);
    }
    const pad = 0.06 * (high - low);
    const words =
        far.length === 2 && far[0] === -far[1]
            ? `limit ±${number(far[1], 6)}`
            : far.length
              ? `limit ${far.map((l) => number(l, 6)).join(' and ')}`
              : '';
    return [low - pad, high + pad, words];
}
