/** What lies under the pointer: the face of the mandrel and the uppermost band over it. */
import { Raycaster, Vector2, Vector3 } from 'three';
import type { Camera, Mesh } from 'three';
import type { Fibre } from './data';
import type { Section } from './section';

/** Stations hashed by place, in buckets that follow one another. */
class StationGrid {
    private readonly start: Uint32Array;
    private readonly entries: Uint32Array;
    private readonly mask: number;

    constructor(
        readonly fibre: Fibre,
        private readonly cellMm: number,
    ) {
        const n = fibre.s.length;
        let size = 1024;
        while (size < n) size *= 2;
        this.mask = size - 1;
        this.start = new Uint32Array(size + 1);
        const bucket = new Uint32Array(n);
        const p = fibre.position;
        for (let i = 0; i < n; ++i) {
            const c = [p[3 * i], p[3 * i + 1], p[3 * i + 2]].map((x) => Math.floor(x / cellMm));
            bucket[i] = this.hash(c[0], c[1], c[2]);
            ++this.start[bucket[i] + 1];
        }
        for (let b = 1; b <= size; ++b) this.start[b] += this.start[b - 1];
        this.entries = new Uint32Array(n);
        const next = this.start.slice();
        for (let i = 0; i < n; ++i) this.entries[next[bucket[i]]++] = i;
    }

    private hash(x: number, y: number, z: number): number {
        return ((x * 73856093) ^ (y * 19349663) ^ (z * 83492791)) & this.mask;
    }

    /** Calls for stations in the cells around a place; some may be called twice or be far away. */
    around(place: Vector3, visit: (station: number) => void): void {
        const c = [place.x, place.y, place.z].map((x) => Math.floor(x / this.cellMm));
        for (let dx = -1; dx <= 1; ++dx) {
            for (let dy = -1; dy <= 1; ++dy) {
                for (let dz = -1; dz <= 1; ++dz) {
                    const b = this.hash(c[0] + dx, c[1] + dy, c[2] + dz);
                    for (let k = this.start[b]; k < this.start[b + 1]; ++k) visit(this.entries[k]);
                }
            }
        }
    }
}

export interface Hit {
    face: number; // of the mandrel, -1: the extension
    place: Vector3; // mandrel frame
    normal: Vector3; // mandrel frame
    band: { fibre: Fibre; station: number } | null;
}

/** What is drawn of a fibre: from a station to another. */
export interface Drawn {
    fibre: Fibre;
    from: number;
    to: number;
}

export class Picker {
    private readonly caster = new Raycaster();
    private readonly grids = new Map<Fibre, StationGrid>();

    constructor(
        private readonly mandrel: Mesh,
        private readonly extension: Mesh | null,
        private readonly widthMm: number,
    ) {}

    /** Sorts the stations of fibres beforehand, which else happens at the first look. */
    prepare(fibres: Fibre[]): void {
        for (const fibre of fibres) this.gridOf(fibre);
    }

    private gridOf(fibre: Fibre): StationGrid {
        let grid = this.grids.get(fibre);
        if (!grid) this.grids.set(fibre, (grid = new StationGrid(fibre, 1.5 * this.widthMm)));
        return grid;
    }

    /**
     * \param at pointer, -1..1 both ways
     * \param shown what is drawn of the fibres, in the order of winding
     * \param section what it cuts away is not seen
     */
    pick(at: Vector2, camera: Camera, shown: Drawn[], section: Section): Hit | null {
        this.caster.setFromCamera(at, camera);
        const targets = this.extension?.visible ? [this.mandrel, this.extension] : [this.mandrel];
        const hits = this.caster.intersectObjects(targets, false);
        const first = hits.find((hit) => section.keeps(hit.point));
        if (!first || !first.face) return null;
        const place = this.mandrel.worldToLocal(first.point.clone());
        const normal = first.face.normal.clone();
        let band: Hit['band'] = null;
        for (let i = shown.length - 1; i >= 0 && !band; --i) {
            const station = this.uppermost(shown[i], place, normal);
            if (station >= 0) band = { fibre: shown[i].fibre, station };
        }
        const face = first.object === this.mandrel ? (first.faceIndex ?? -1) : -1;
        return { face, place, normal, band };
    }

    private uppermost({ fibre, from, to }: Drawn, place: Vector3, normal: Vector3): number {
        const grid = this.gridOf(fibre);
        const { position: p, normal: m, tangent: t } = fibre;
        const half = this.widthMm / 2;
        let best = -1;
        grid.around(place, (i) => {
            if (i <= best || i < from || i > to) return;
            const k = 3 * i;
            const d = [place.x - p[k], place.y - p[k + 1], place.z - p[k + 2]];
            const facing = m[k] * normal.x + m[k + 1] * normal.y + m[k + 2] * normal.z;
            if (facing < 0.2) return;
            const along = d[0] * t[k] + d[1] * t[k + 1] + d[2] * t[k + 2];
            const height = d[0] * m[k] + d[1] * m[k + 1] + d[2] * m[k + 2];
            const across = Math.sqrt(
                Math.max(d[0] ** 2 + d[1] ** 2 + d[2] ** 2 - along ** 2 - height ** 2, 0),
            );
            const reach = Math.max(stepAt(fibre, i), 0.1);
            if (across <= half && Math.abs(along) <= reach && Math.abs(height) < this.widthMm) best = i;
        });
        return best;
    }
}

/** Longer of the steps to the neighbouring stations. */
function stepAt(fibre: Fibre, i: number): number {
    const p = fibre.position;
    const length = (a: number, b: number) =>
        Math.hypot(p[3 * a] - p[3 * b], p[3 * a + 1] - p[3 * b + 1], p[3 * a + 2] - p[3 * b + 2]);
    const n = fibre.s.length;
    return 0.6 * Math.max(i > 0 ? length(i, i - 1) : 0, i + 1 < n ? length(i, i + 1) : 0);
}
