/** Position, speed and acceleration of each axis over the common clock. */
import type { Timeline } from './timeline';

export interface AxisMotion {
    position: Float64Array; // at the block's end
    speed: Float64Array; // over the block; NaN at the start of a program
    acceleration: Float64Array; // that the block needs, without sign; NaN at the start of a program
}

export class Motion {
    readonly time: Float64Array; // common clock, at the block's end
    readonly first: number[] = []; // of each program, entry of its block 0
    private readonly cache: (AxisMotion | undefined)[] = [];

    constructor(private readonly timeline: Timeline) {
        const count = timeline.programs.reduce((sum, p) => sum + p.fibre.time.length, 0);
        this.time = new Float64Array(count);
        let entry = 0;
        for (const program of timeline.programs) {
            this.first.push(entry);
            for (const t of program.fibre.time) this.time[entry++] = program.start + t;
        }
    }

    of(axis: number): AxisMotion {
        return (this.cache[axis] ??= this.compute(axis));
    }

    /**
     * Speed: increment over the block's time. Acceleration: the least with which half the ramp
     * from the block before and half the ramp to the next fit into the block, at the speeds and
     * times that the program asks for, as the check of the axis limits has it; from rest at the
     * start and to rest at the end.
     */
    private compute(axis: number): AxisMotion {
        const count = this.time.length;
        const n = this.timeline.axes.length;
        const position = new Float64Array(count);
        const speed = new Float64Array(count).fill(NaN);
        const acceleration = new Float64Array(count).fill(NaN);
        this.timeline.programs.forEach((program, p) => {
            const { axes, time, asked } = program.fibre;
            const base = this.first[p];
            const span = (b: number) => time[b] - time[b - 1];
            for (let b = 0; b < time.length; ++b) {
                position[base + b] = axes[b * n + axis];
                if (b === 0 || !(span(b) > 0)) continue;
                speed[base + b] = (position[base + b] - position[base + b - 1]) / span(b);
            }
            const wanted = (b: number) => (position[base + b] - position[base + b - 1]) / asked[b];
            let before = 0;
            for (let b = 1; b < time.length; ++b) {
                if (!(asked[b] > 0)) continue;
                const v = wanted(b);
                let next = b + 1;
                while (next < time.length && !(asked[next] > 0)) ++next;
                const after = next < time.length ? wanted(next) : 0;
                acceleration[base + b] = (Math.abs(v - before) + Math.abs(after - v)) / 2 / asked[b];
                before = v;
            }
        });
        return { position, speed, acceleration };
    }
}
