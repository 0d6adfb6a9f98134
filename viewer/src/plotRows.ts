/** What the three plots of an axis show, and their scales. */
import { number } from './format';
import type { AxisMotion } from './motion';
import type { Axis } from './types';

/** A limit farther off than so many times the data's size is named, not drawn. */
const kFarLimit = 2.5;

export interface Row {
    label: string;
    unit: string;
    values: Float64Array;
    steps: 'line' | 'block';
    about: 'data' | 'zero' | 'above-zero'; // what its scale begins with
    low: number | null; // limits
    high: number | null;
}

export function rowsOf(axis: Axis, motion: AxisMotion): Row[] {
    const unit = axis.type === 'linear' ? 'mm' : '°';
    const { velocity, acceleration } = axis;
    return [
        {
            label: 'Position',
            unit,
            values: motion.position,
            steps: 'line',
            about: 'data',
            low: axis.min,
            high: axis.max,
        },
        {
            label: 'Speed',
            unit: `${unit}/s`,
            values: motion.speed,
            steps: 'block',
            about: 'zero',
            low: velocity && -velocity,
            high: velocity,
        },
        {
            label: 'Acceleration',
            unit: `${unit}/s²`,
            values: motion.acceleration,
            steps: 'block',
            about: 'above-zero',
            low: null,
            high: acceleration,
        },
    ];
}

export function tickStep(span: number, ticks: number): number {
    const rough = span / Math.max(ticks, 1);
    const power = 10 ** Math.floor(Math.log10(rough));
    return power * ([1, 2, 5, 10].find((f) => f * power >= rough) ?? 10);
}

export function limitWords(row: Row): string {
    const { low, high } = row;
    if (low === null && high === null) return '';
    if (low === null) return `limit ${number(high, 6)}`;
    if (high === null) return `limit ${number(low, 6)}`;
    return low === -high ? `limit ±${number(high, 6)}` : `limits ${number(low, 6)} and ${number(high, 6)}`;
}

/** Lower and upper end of a row; limits that are not far off are within. */
export function rangeOf(row: Row, first: number, last: number): [number, number] {
    let low = Infinity;
    let high = -Infinity;
    for (let i = first; i <= last; ++i) {
        const v = row.values[i];
        if (Number.isNaN(v)) continue;
        low = Math.min(low, v);
        high = Math.max(high, v);
    }
    if (low > high) [low, high] = [0, 1];
    if (row.about === 'zero') {
        high = Math.max(Math.abs(low), Math.abs(high));
        low = -high;
    } else if (row.about === 'above-zero') low = 0;
    if (high - low < 1e-9) [low, high] = [row.about === 'above-zero' ? 0 : low - 0.5, high + 0.5];
    const [bottom, top] = [low, high];
    for (const limit of [row.low, row.high]) {
        const off = limit === null ? Infinity : Math.abs(limit - (top + bottom) / 2);
        if (limit === null || off > (kFarLimit * (top - bottom)) / 2) continue;
        low = Math.min(low, limit);
        high = Math.max(high, limit);
    }
    return [low, high];
}
