/** The picture of a part: its body, marks and labels. */
import { Raycaster, Vector2, Vector3 } from 'three';
import { View } from '../scene';
import { nearestNormal } from '../shape';
import { cssVariable } from '../theme';
import { Body } from './body';
import type { Part } from './data';
import type { Colours } from './kinds';
import { Labels } from './labels';
import type { Label } from './labels';
import { Marks } from './marks';

/** The spindle lies, and what stands off it farthest stands up. */
export const kUp = new Vector3(1, 0, 0);
export const kFirstView = new Vector3(0.5, 0.8, -0.38);
export const kCloseShare = 1.1; // of the part's diagonal: from where a place is looked at
const kFitPoints = 2000;

/** As many points as it takes to fit a view to all of them. */
export function someOf(points: Float32Array): Vector3[] {
    const step = 3 * Math.max(1, Math.floor(points.length / 3 / kFitPoints));
    const some: Vector3[] = [];
    for (let i = 0; i + 2 < points.length; i += step) some.push(new Vector3().fromArray(points, i));
    return some;
}

export interface Hit {
    region: number; // -1: taken off
    sharp: boolean;
    place: Vector3;
}

export class PartStage {
    readonly view: View;
    readonly body: Body;
    readonly labels: Labels;
    private readonly marks: Marks;
    private readonly caster = new Raycaster();
    private readonly size: number;

    constructor(
        private readonly part: Part,
        canvas: HTMLCanvasElement,
        labelHost: HTMLElement,
    ) {
        this.view = new View(canvas, kUp);
        this.body = new Body(part);
        const geometry = this.body.mesh.geometry;
        geometry.computeBoundingBox();
        const box = geometry.boundingBox;
        const [low, high] = [box?.min ?? new Vector3(), box?.max ?? new Vector3()];
        this.size = high.distanceTo(low);
        this.marks = new Marks(part, this.size, low.z, high.z);
        this.view.world.add(this.body.group, this.marks.group);
        this.labels = new Labels(labelHost, this.labelsOf());
        this.view.afterRender = () => this.labels.place(this.view.camera);
        this.setTheme();
    }

    setTheme(): void {
        this.view.setBackground(cssVariable('--sky'));
        this.body.setTheme();
        this.marks.setTheme();
        this.view.request();
    }

    colour(by: Colours): void {
        this.body.colour(by);
        this.view.request();
    }

    cutOpen(on: boolean): void {
        this.body.cutOpen(on);
        this.view.request();
    }

    showTriangles(on: boolean): void {
        this.body.showTriangles(on);
        this.view.request();
    }

    showMarks(on: boolean): void {
        this.marks.group.visible = on;
        this.labels.show(on);
        this.view.request();
    }

    choose(region: number | null): void {
        this.body.choose(region);
        this.view.request();
    }

    /** Draws one of the lines that the part might turn about; null: none. */
    showAxis(number: number | null): void {
        this.marks.showCandidate(number === null ? null : this.part.inspected.axis.candidates[number]);
        this.view.request();
    }

    fit(): void {
        this.view.resize();
        this.view.fit([this.marks.spindleTip, ...this.marks.rimTips, ...someOf(this.part.points)], kFirstView);
    }

    flyTo(label: Label): void {
        const direction = label.normal?.clone() ?? label.at.clone();
        direction.addScaledVector(kUp, 0.25);
        if (Math.abs(direction.normalize().dot(kUp)) > 0.95) direction.add(new Vector3(0, 0.4, -0.3)).normalize();
        this.view.flyTo(label.at, direction, kCloseShare * this.size);
    }

    /** \param at pointer, -1..1 both ways */
    pick(at: Vector2): Hit | null {
        this.view.world.updateMatrixWorld();
        this.caster.setFromCamera(at, this.view.camera);
        const targets = this.body.details.visible ? [this.body.mesh, this.body.details] : [this.body.mesh];
        const hits = this.caster.intersectObjects(targets, false);
        const hit = hits.find((h) => !this.body.isCut() || h.point.y <= 0);
        if (!hit || hit.faceIndex === undefined || hit.faceIndex === null) return null;
        const face = hit.faceIndex;
        return hit.object === this.body.details
            ? { region: -1, sharp: false, place: hit.point }
            : { region: this.part.region[face], sharp: this.part.sharp[face] > 0, place: hit.point };
    }

    private labelsOf(): Label[] {
        const { rims, places, remarks } = this.part.inspected;
        const labels: Label[] = places.map(({ remark, at }) => ({
            id: `remark-${remark}`,
            kind: 'remark',
            words: String(remark + 1),
            title: remarks[remark],
            at: new Vector3(...at),
            normal: nearestNormal(this.part, new Vector3(...at)),
        }));
        rims.forEach((rim, i) =>
            labels.push({
                id: `rim-${rim.id}`,
                kind: 'rim',
                words: `rim ${rim.id}`,
                title: `Rim ${rim.id}`,
                at: this.marks.rimTips[i],
                normal: null,
            }),
        );
        labels.push({
            id: 'spindle',
            kind: 'spindle',
            words: 'spindle, Z',
            title: 'The spindle axis',
            at: this.marks.spindleTip,
            normal: null,
        });
        return labels;
    }
}
