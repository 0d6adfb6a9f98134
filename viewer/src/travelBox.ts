/** Where the linear axes can bring the eye while the rotary ones stand at zero. */
import { BufferGeometry, LineBasicMaterial, LineSegments, Vector3 } from 'three';
import type { Kinematics } from './kinematics';
import type { Timeline } from './timeline';

export class TravelBox {
    readonly lines: LineSegments<BufferGeometry, LineBasicMaterial>; // base frame

    constructor(kinematics: Kinematics, timeline: Timeline) {
        this.lines = new LineSegments(
            new BufferGeometry().setFromPoints(edges(kinematics, timeline)),
            new LineBasicMaterial(),
        );
        this.lines.visible = false;
    }

    /** Whether the machine has an axis that makes a box. */
    isEmpty(): boolean {
        return this.lines.geometry.getAttribute('position').count === 0;
    }

    setTheme(colour: string): void {
        this.lines.material.color.setStyle(colour, '');
    }
}

/** Pairs of corners; of an axis without ends as far as the programs go. */
function edges(kinematics: Kinematics, timeline: Timeline): Vector3[] {
    const { axes } = kinematics;
    const first = kinematics.machine.mandrel_chain.length;
    const own = axes.flatMap(({ type }, i) => (i >= first && type === 'linear' ? [i] : []));
    const ends = own.map((i) => {
        let [low, high] = [Infinity, -Infinity];
        for (const { fibre } of timeline.programs) {
            for (let k = i; k < fibre.axes.length; k += axes.length) {
                low = Math.min(low, fibre.axes[k]);
                high = Math.max(high, fibre.axes[k]);
            }
        }
        const used = high >= low ? [low, high] : [0, 0];
        return [axes[i].min ?? used[0], axes[i].max ?? used[1]];
    });
    const corner = (which: number): Vector3 => {
        const q = axes.map(() => 0);
        own.forEach((axis, k) => {
            q[axis] = ends[k][(which >> k) & 1];
        });
        return kinematics.pose(q).eyeBase;
    };
    const points: Vector3[] = [];
    for (let which = 0; which < 1 << own.length; ++which) {
        own.forEach((_, k) => {
            if (!((which >> k) & 1)) points.push(corner(which), corner(which | (1 << k)));
        });
    }
    return points;
}
