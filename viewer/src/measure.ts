/** The way from one place of the part to another, in figures and in the picture. */
import {
    BufferAttribute,
    BufferGeometry,
    Group,
    Line,
    LineBasicMaterial,
    Mesh,
    MeshBasicMaterial,
    SphereGeometry,
    Vector3,
} from 'three';
import { fixed } from './format';

const kDotOfPart = 0.006; // radius of a dot, of the part's diagonal

export interface Measured {
    distance: number; // straight, mm
    along: number; // the spindle, mm, towards its end
    radii: [number, number]; // from the spindle, mm
    around: number; // the spindle, deg -180..180; 0 where a place is on it
}

export function measured(from: Vector3, to: Vector3): Measured {
    const turn = (Math.atan2(from.x * to.y - from.y * to.x, from.x * to.x + from.y * to.y) * 180) / Math.PI;
    return {
        distance: from.distanceTo(to),
        along: to.z - from.z,
        radii: [Math.hypot(from.x, from.y), Math.hypot(to.x, to.y)],
        around: turn,
    };
}

/** \param places of the mandrel, up to two */
export function measuredHtml(places: Vector3[]): string {
    const row = (name: string, words: string): string => `<dt>${name}</dt><dd>${words}</dd>`;
    const mm = (value: number): string => `${fixed(value, 2)}\u202fmm`;
    const rows = places.map((p, i) =>
        row(i ? 'to' : 'from', p.toArray().map((c) => fixed(c, 2)).join('\u2002')),
    );
    if (places.length < 2) {
        return `<h4>${places.length ? 'Click the other place' : 'Click a place of the part'}</h4><dl>${rows.join('')}</dl>`;
    }
    const { distance, along, radii, around } = measured(places[0], places[1]);
    rows.push(row('along the spindle', mm(along)));
    rows.push(row('radius', `${fixed(radii[0], 2)} \u2192 ${mm(radii[1])}`));
    rows.push(row('around it', `${fixed(around, 2)}°`));
    return `<h4>${mm(distance)} apart</h4><dl>${rows.join('')}</dl>`;
}

export class Measure {
    readonly group = new Group(); // mandrel frame
    on = false;
    places: Vector3[] = [];
    private readonly dots: Mesh[];
    private readonly line: Line<BufferGeometry, LineBasicMaterial>;

    /** \param diagonal of the part, mm */
    constructor(diagonal: number) {
        const material = new MeshBasicMaterial({ depthTest: false, transparent: true });
        const sphere = new SphereGeometry(kDotOfPart * diagonal, 16, 12);
        this.dots = [0, 1].map(() => new Mesh(sphere, material));
        this.line = new Line(
            new BufferGeometry(),
            new LineBasicMaterial({ depthTest: false, transparent: true }),
        );
        this.line.geometry.setAttribute('position', new BufferAttribute(new Float32Array(6), 3));
        for (const part of [this.line, ...this.dots]) {
            part.frustumCulled = false;
            part.renderOrder = 1001;
            this.group.add(part);
        }
        this.show();
    }

    setTheme(colour: string): void {
        this.line.material.color.setStyle(colour, '');
        (this.dots[0].material as MeshBasicMaterial).color.setStyle(colour, '');
    }

    /** Begins, or takes away what was measured. */
    turn(on: boolean): void {
        this.on = on;
        this.places = [];
        this.show();
    }

    /** The first place, the second one, or the first of another way. */
    take(place: Vector3): void {
        if (this.places.length === 2) this.places = [];
        this.places.push(place.clone());
        this.show();
    }

    private show(): void {
        this.dots.forEach((dot, i) => {
            dot.visible = i < this.places.length;
            if (dot.visible) dot.position.copy(this.places[i]);
        });
        this.line.visible = this.places.length === 2;
        if (!this.line.visible) return;
        const ends = this.line.geometry.getAttribute('position') as BufferAttribute;
        this.places.forEach((p, i) => ends.setXYZ(i, p.x, p.y, p.z));
        ends.needsUpdate = true;
    }
}
