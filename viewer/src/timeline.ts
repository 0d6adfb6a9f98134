/** All programs one after the other on one clock: what the axes and the landing point do when. */
import { Vector3 } from 'three';
import type { Fibre, Page } from './data';
import type { Axis } from './types';

export interface Program {
    index: number;
    fibre: Fibre;
    start: number; // s on the common clock
    end: number;
    label: string;
}

export interface Moment {
    time: number; // common clock, s
    program: Program;
    block: number; // the block under way; 0 at the start
    share: number; // of it that is done, 0..1
    axes: Float64Array;
    station: number; // landing point as it is planned, fractional; -1 unknown
}

const kAxisJoin = 1e-12;

export class Timeline {
    readonly programs: Program[] = [];
    readonly duration: number;

    constructor(
        page: Page,
        readonly axes: Axis[],
    ) {
        const several = page.layers.length > 1;
        let start = 0;
        for (const layer of page.layers) {
            for (const fibre of layer.fibres) {
                const length = fibre.time.length ? fibre.time[fibre.time.length - 1] : 0;
                const parts = several ? [`Layer ${fibre.layer + 1}`] : [];
                if (layer.fibres.length > 1) parts.push(`Fibre ${fibre.fibre + 1}`);
                this.programs.push({
                    index: this.programs.length,
                    fibre,
                    start,
                    end: start + length,
                    label: parts.join(', ') || 'Program',
                });
                start += length;
            }
        }
        if (!this.programs.length) throw new Error('The data has no fibre.');
        this.duration = start;
    }

    /** The program under way; between two of them the one that ends, unless it is told. */
    programAt(time: number): Program {
        return this.programs.find((p) => time <= p.end) ?? this.programs[this.programs.length - 1];
    }

    at(time: number, program = this.programAt(time)): Moment {
        const { fibre } = program;
        if (!fibre.time.length) return standstill(program, this.axes.length);
        const local = Math.min(Math.max(time - program.start, 0), program.end - program.start);
        const block = upperBlock(fibre.time, local);
        const before = Math.max(block - 1, 0);
        const from = fibre.time[before];
        const span = fibre.time[block] - from;
        const share = span > 0 ? (local - from) / span : 1;
        const n = this.axes.length;
        const axes = new Float64Array(n);
        for (let i = 0; i < n; ++i) {
            const a = fibre.axes[before * n + i];
            axes[i] = a + share * (fibre.axes[block * n + i] - a);
        }
        return {
            time: program.start + local,
            program,
            block,
            share,
            axes,
            station: stationBetween(fibre, before, block, share),
        };
    }

    /** Time on the common clock at which a block ends. */
    endOf(program: Program, block: number): number {
        const { time } = program.fibre;
        if (!time.length) return program.start;
        return program.start + time[Math.min(Math.max(block, 0), time.length - 1)];
    }
}

/** Speed of each axis in the block under way, mm/s or deg/s; NaN where none is. */
export function speedsAt({ program, block, axes }: Moment): Float64Array {
    const { fibre } = program;
    const n = axes.length;
    const span = block > 0 ? fibre.time[block] - fibre.time[block - 1] : 0;
    return axes.map((_, i) =>
        span > 0 ? (fibre.axes[block * n + i] - fibre.axes[(block - 1) * n + i]) / span : NaN,
    );
}

/** What is shown of a fibre without blocks: all of it, with the axes at zero. */
function standstill(program: Program, axes: number): Moment {
    return {
        time: program.start,
        program,
        block: 0,
        share: 1,
        axes: new Float64Array(axes),
        station: program.fibre.s.length - 1,
    };
}

/** First block whose end is not before `time`. */
export function upperBlock(times: Float64Array, time: number): number {
    let low = 0;
    let high = times.length - 1;
    while (low < high) {
        const middle = (low + high) >> 1;
        if (times[middle] < time - kAxisJoin) low = middle + 1;
        else high = middle;
    }
    return low;
}

function stationBetween(fibre: Fibre, before: number, block: number, share: number): number {
    let from = fibre.station[before];
    const to = fibre.station[block];
    for (let b = before; from < 0 && b > 0; --b) from = fibre.station[b];
    if (to < 0) return from;
    if (from < 0) return to;
    return from + share * (to - from);
}

export interface Landing {
    station: number;
    point: Vector3; // mandrel frame
    normal: Vector3;
    tangent: Vector3;
}

const kSearchStations = 24;
/** Sine of the angle between free fibre and tangent plane that is left as it is (0.4 deg). */
const kTangentSine = 0.007;

/**
 * The landing point for an eye: near the planned station, where the eye lies in the tangent plane
 * of the surface, since the free fibre leaves it there.
 */
export function landingPoint(fibre: Fibre, planned: number, eye: Vector3): Landing | null {
    if (planned < 0 || !fibre.position.length) return null;
    const last = fibre.s.length - 1;
    const guess = Math.min(planned, last);
    const lift = (i: number): number => {
        const k = 3 * i;
        const { position: p, normal: n } = fibre;
        return (eye.x - p[k]) * n[k] + (eye.y - p[k + 1]) * n[k + 1] + (eye.z - p[k + 2]) * n[k + 2];
    };
    const planar = landingAt(fibre, guess);
    const free = eye.clone().sub(planar.point);
    if (Math.abs(free.dot(planar.normal)) < kTangentSine * free.length()) return planar;
    let station = guess;
    const first = Math.max(0, Math.floor(guess) - kSearchStations);
    const end = Math.min(last, Math.ceil(guess) + kSearchStations);
    let nearest = Infinity;
    for (let i = first; i < end; ++i) {
        const a = lift(i);
        const b = lift(i + 1);
        if (!(a >= 0 && b < 0)) continue;
        const crossing = i + a / (a - b);
        const off = Math.abs(crossing - guess);
        if (off < nearest) {
            nearest = off;
            station = crossing;
        }
    }
    return landingAt(fibre, station);
}

export function landingAt(fibre: Fibre, station: number): Landing {
    const last = fibre.s.length - 1;
    const i = Math.min(Math.floor(station), last);
    const j = Math.min(i + 1, last);
    const t = station - i;
    const mix = (a: Float32Array) =>
        new Vector3(a[3 * i], a[3 * i + 1], a[3 * i + 2]).lerp(
            new Vector3(a[3 * j], a[3 * j + 1], a[3 * j + 2]),
            t,
        );
    return {
        station,
        point: mix(fibre.position),
        normal: mix(fibre.normal).normalize(),
        tangent: mix(fibre.tangent).normalize(),
    };
}
