/** What the first view and Fit take in: the part as it turns, and the head wherever the program brings it. */
import { Box3, Matrix4, Vector3 } from 'three';
import type { CameraMode } from './cameraMode';
import type { Page } from './data';
import type { Kinematics, Pose } from './kinematics';
import type { Timeline } from './timeline';
import type { Body } from './types';

const kCloudPoints = 1000; // that are looked at of mandrel, extension, all fibres
const kDirections = 128;
const kPoses = 300; // spread over all programs
/** Of the part's diagonal: so much of the head is taken in, from the eye on; a ram may be much longer. */
const kHeadReach = 0.25;

/** Points of one link of the head, where they are with all axes at zero. */
interface HeadLink {
    letter: string | null;
    points: Vector3[];
}

export class Framing {
    private readonly part: Vector3[]; // mandrel frame
    private readonly head: HeadLink[];
    private readonly clouds = new Map<string, Vector3[]>();

    constructor(
        private readonly page: Page,
        private readonly kinematics: Kinematics,
        private readonly timeline: Timeline,
    ) {
        const fibres = timeline.programs.map((p) => p.fibre.position);
        const each = Math.ceil(kCloudPoints / fibres.length);
        this.part = extremes([
            ...sample(page.points, kCloudPoints),
            ...sample(page.extension?.points ?? [], kCloudPoints),
            ...fibres.flatMap((cloud) => sample(cloud, each)),
        ]);
        const size = new Box3().setFromPoints(this.part).getSize(new Vector3()).length();
        this.head = kinematics.machine.eye.envelope.map((body) => this.linkOf(body, kHeadReach * size));
    }

    /** What is to be seen, in the frame that the camera stands in. */
    points(mode: CameraMode, withHead: boolean): Vector3[] {
        const key = `${mode} ${withHead}`;
        let cloud = this.clouds.get(key);
        if (!cloud) this.clouds.set(key, (cloud = this.gather(mode, withHead)));
        return cloud;
    }

    /** Eye and head, base frame. */
    headAt(pose: Pose): Vector3[] {
        const own = this.head.flatMap(({ letter, points }) => {
            const matrix = letter === null ? undefined : pose.links.get(letter);
            return points.map((p) => (matrix ? p.clone().applyMatrix4(matrix) : p.clone()));
        });
        return [pose.eyeBase.clone(), ...own];
    }

    /** Outermost points of the part, base frame. */
    partAt(pose: Pose): Vector3[] {
        return this.part.map((p) => p.clone().applyMatrix4(pose.baseFromMandrel));
    }

    private gather(mode: CameraMode, withHead: boolean): Vector3[] {
        const all = this.poses().flatMap((pose) => {
            const seen = [...this.partAt(pose), ...(withHead ? this.headAt(pose) : [])];
            const back = mode === 'machine' ? new Matrix4() : pose.baseFromMandrel.clone().invert();
            return seen.map((p) => p.applyMatrix4(back));
        });
        return extremes(all);
    }

    /** Some of all programs, with those where an axis is at an end of its travel. */
    private poses(): Pose[] {
        const n = this.kinematics.axes.length;
        const programs = this.timeline.programs.map((p) => p.fibre.axes).filter((axes) => axes.length);
        const poseOf = (axes: Float64Array, block: number): Pose =>
            this.kinematics.pose(axes.subarray(block * n, (block + 1) * n));
        if (!programs.length) return [poseOf(new Float64Array(n), 0)];
        const each = Math.max(Math.ceil(kPoses / programs.length), 2);
        const poses = programs.flatMap((axes) =>
            Array.from({ length: each }, (_, k) => poseOf(axes, Math.round((k * (axes.length / n - 1)) / (each - 1)))),
        );
        for (let axis = 0; axis < n; ++axis) {
            const low = { axes: programs[0], at: axis };
            const high = { axes: programs[0], at: axis };
            for (const axes of programs) {
                for (let at = axis; at < axes.length; at += n) {
                    if (axes[at] < low.axes[low.at]) [low.axes, low.at] = [axes, at];
                    if (axes[at] > high.axes[high.at]) [high.axes, high.at] = [axes, at];
                }
            }
            for (const { axes, at } of [low, high]) poses.push(poseOf(axes, Math.floor(at / n)));
        }
        return poses;
    }

    private linkOf(body: Body, reach: number): HeadLink {
        const eye = new Vector3(...this.kinematics.machine.eye.position);
        const near = (p: Vector3): Vector3 => p.sub(eye).clampLength(0, reach).add(eye);
        if (body.type === 'mesh') {
            const points = extremes(sample(this.page.array(body.points), kCloudPoints));
            return { letter: body.link, points: points.map(near) };
        }
        const ends = [body.from, body.to].map((end) => near(new Vector3(...end)));
        const points = ends.flatMap((end) =>
            kAround.map((d) => end.clone().addScaledVector(d, body.radius)),
        );
        return { letter: body.link, points };
    }
}

const kAround = [1, -1].flatMap((s) => [new Vector3(s, 0, 0), new Vector3(0, s, 0), new Vector3(0, 0, s)]);

/** So many points of a cloud, or somewhat more, all over it. */
function sample(cloud: ArrayLike<number>, count: number): Vector3[] {
    const step = 3 * Math.max(1, Math.floor(cloud.length / 3 / count));
    const points: Vector3[] = [];
    for (let i = 0; i + 2 < cloud.length; i += step) points.push(new Vector3().fromArray(cloud, i));
    return points;
}

/** Directions evenly over the sphere, on a spiral. */
const directions = Array.from({ length: kDirections }, (_, k) => {
    const z = 1 - (2 * k + 1) / kDirections;
    const turn = k * Math.PI * (3 - Math.sqrt(5));
    const r = Math.sqrt(1 - z * z);
    return new Vector3(r * Math.cos(turn), r * Math.sin(turn), z);
});

/** Those of the points that are farthest out in some direction. */
function extremes(points: Vector3[]): Vector3[] {
    const outermost = directions.map((d) => {
        let best = points[0];
        for (const p of points) if (p.dot(d) > best.dot(d)) best = p;
        return best;
    });
    return [...new Set(outermost)];
}
