/** Rims as circles with their axes, and the spindle: solid where they are seen, faint behind the part. */
import {
    Color,
    ConeGeometry,
    CylinderGeometry,
    Group,
    Line,
    BufferGeometry,
    BufferAttribute,
    LineBasicMaterial,
    Mesh,
    MeshBasicMaterial,
    Quaternion,
    TorusGeometry,
    Vector3,
} from 'three';
import { kBare } from '../colour';
import { cssVariable } from '../theme';
import type { Vec3 } from '../types';
import type { Part, Rim } from './data';

const kThick = 0.004; // of the part's diagonal
const kGhost = 0.22;
const kOffShare = 0.02; // of its radius: the loop of a rim further off its circle is drawn as well

type Basic = MeshBasicMaterial;

export class Marks {
    readonly group = new Group();
    readonly rimTips: Vector3[] = [];
    readonly spindleTip: Vector3;
    private readonly rimMaterials = pair();
    private readonly spindleMaterials = pair();
    private readonly candidateMaterials = pair();
    private candidate: Mesh[] = [];
    private readonly thick: number;

    constructor(
        part: Part,
        private readonly size: number,
        low: number,
        high: number,
    ) {
        const thick = kThick * size;
        this.thick = thick;
        part.inspected.rims.forEach((rim, i) => {
            this.addRim(rim, thick, size);
            if (rim.circularity_mm > kOffShare * rim.radius) this.addLoop(part.loops[i]);
        });
        const over = 0.1 * size;
        const foot = new Vector3(0, 0, low - over);
        this.spindleTip = new Vector3(0, 0, high + over);
        this.addArrow(foot, this.spindleTip, 0.6 * thick, this.spindleMaterials);
    }

    setTheme(): void {
        for (const m of this.rimMaterials) m.color = new Color().setStyle(cssVariable('--text'), '');
        for (const m of this.candidateMaterials) m.color = new Color().setStyle(cssVariable('--fibre'), '');
        for (const m of this.spindleMaterials) m.color = new Color().setStyle(cssVariable('--accent'), '');
    }

    /** Draws a line that the part might turn about, through a place; null: none. */
    showCandidate(axis: { through: Vec3; direction: Vec3 } | null): void {
        this.group.remove(...this.candidate);
        for (const mesh of this.candidate) mesh.geometry.dispose();
        this.candidate = [];
        if (!axis) return;
        const through = new Vector3(...axis.through);
        const along = new Vector3(...axis.direction).multiplyScalar(0.65 * this.size);
        const from = through.clone().sub(along);
        this.candidate = this.addArrow(from, through.add(along), 0.6 * this.thick, this.candidateMaterials);
    }

    private addRim(rim: Rim, thick: number, size: number): void {
        const axis = new Vector3(...rim.axis);
        const centre = new Vector3(...rim.centre);
        const circle = new TorusGeometry(rim.radius, thick, 8, 160);
        for (const material of this.rimMaterials) {
            const mesh = new Mesh(circle, material);
            mesh.position.copy(centre);
            mesh.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), axis);
            this.addMesh(mesh);
        }
        const tip = centre.clone().addScaledVector(axis, Math.max(0.08 * size, 0.45 * rim.radius));
        this.addArrow(centre, tip, 0.6 * thick, this.rimMaterials);
        this.rimTips.push(tip);
    }

    private addLoop(loop: Float32Array): void {
        const closed = new Float32Array(loop.length + 3);
        closed.set(loop);
        closed.set(loop.subarray(0, 3), loop.length);
        const geometry = new BufferGeometry();
        geometry.setAttribute('position', new BufferAttribute(closed, 3));
        const material = new LineBasicMaterial({ depthTest: false, transparent: true });
        material.color.setStyle(kBare, '');
        const line = new Line(geometry, material);
        line.renderOrder = 20;
        this.group.add(line);
    }

    private addArrow(from: Vector3, to: Vector3, radius: number, materials: Basic[]): Mesh[] {
        const added: Mesh[] = [];
        const along = to.clone().sub(from);
        const length = along.length();
        const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), along.normalize());
        const head = Math.min(7 * radius, length / 2);
        for (const material of materials) {
            const shaft = new Mesh(new CylinderGeometry(radius, radius, length - head, 12), material);
            shaft.position.copy(from).addScaledVector(along, (length - head) / 2);
            const cone = new Mesh(new ConeGeometry(3 * radius, head, 16), material);
            cone.position.copy(to).addScaledVector(along, -head / 2);
            for (const mesh of [shaft, cone]) {
                mesh.quaternion.copy(turn);
                this.addMesh(mesh);
                added.push(mesh);
            }
        }
        return added;
    }

    private addMesh(mesh: Mesh): void {
        mesh.renderOrder = (mesh.material as Basic).depthTest ? 12 : 10;
        this.group.add(mesh);
    }
}

/** Seen, and through the part. */
function pair(): Basic[] {
    return [
        new MeshBasicMaterial(),
        new MeshBasicMaterial({ depthTest: false, depthWrite: false, transparent: true, opacity: kGhost }),
    ];
}
