/** Position, speed and acceleration of each axis over the common clock. */
import type { Timeline } from './timeline';

export interface AxisMotion {
    position: Float64Array; // at the block's end
    speed: Float64Array; // over the block; NaN at the start of a program
    acceleration: Float64Array; // at the block's end, towards the next; NaN at starts and ends
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
     * Speed: increment over the block's time. Acceleration: the least that changes the speed of one
     * block into that of the next within half of both.
     */
    private compute(axis: number): AxisMotion {
        const count = this.time.length;
        const n = this.timeline.axes.length;
        const position = new Float64Array(count);
        const speed = new Float64Array(count).fill(NaN);
        const acceleration = new Float64Array(count).fill(NaN);
        this.timeline.programs.forEach((program, p) => {
            const { axes, time } = program.fibre;
            const base = this.first[p];
            for (let b = 0; b < time.length; ++b) {
                position[base + b] = axes[b * n + axis];
                if (b === 0) continue;
                const span = time[b] - time[b - 1];
                if (span > 0) speed[base + b] = (position[base + b] - position[base + b - 1]) / span;
                if (b < 2) continue;
                const both = (time[b] - time[b - 2]) / 2;
                acceleration[base + b - 1] = (speed[base + b] - speed[base + b - 1]) / both;
            }
        });
        return { position, speed, acceleration };
    }
}
