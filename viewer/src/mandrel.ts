/** The mandrel: shaded between its feature edges, with values per face. */
import {
    BufferAttribute,
    BufferGeometry,
    Color,
    DoubleSide,
    Group,
    LineBasicMaterial,
    LineSegments,
    Mesh,
    ShaderMaterial,
} from 'three';
import { kBare, sequentialTexture } from './colour';
import type { Colouring } from './colour';
import type { Page } from './data';
import { kMandrelFragment, kMandrelVertex } from './shaders';

/** Edges that turn by more are features: lines are drawn there and shading breaks. */
const kFeatureCosine = Math.cos((30 * Math.PI) / 180);

export class Mandrel {
    readonly group = new Group();
    readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
    private readonly lines: LineSegments<BufferGeometry, LineBasicMaterial>;
    private readonly kept: Set<number> | null;
    private points: Float32Array | null = null;

    constructor(private readonly page: Page) {
        const regions = page.header.report.mandrel?.regions;
        this.kept = regions ? new Set(regions.filter((r) => r.kept).map((r) => r.id)) : null;
        const material = new ShaderMaterial({
            vertexShader: kMandrelVertex,
            fragmentShader: kMandrelFragment,
            uniforms: {
                colour: { value: new Color() },
                otherColour: { value: new Color() },
                bareColour: { value: new Color().setStyle(kBare, '') },
                useValue: { value: 0 },
                showBare: { value: 1 },
                range: { value: [0, 1] },
                map: { value: sequentialTexture },
            },
            side: DoubleSide,
            polygonOffset: true,
            polygonOffsetFactor: 1,
            polygonOffsetUnits: 1,
        });
        this.mesh = new Mesh(new BufferGeometry(), material);
        this.lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial());
        this.group.add(this.mesh, this.lines);
        this.show(null);
    }

    /** Shape and values of one layer's mandrel (index), or of the bare mandrel with all layers. */
    show(layer: number | null): void {
        const points = layer === null ? this.page.points : this.page.layers[layer].points;
        if (points !== this.points) {
            this.points = points;
            const shape = shapeOf(points, this.page.faces);
            this.mesh.geometry.dispose();
            this.lines.geometry.dispose();
            this.mesh.geometry = shape.surface;
            this.lines.geometry = shape.edges;
        }
        const layers = (layer === null ? this.page.total : this.page.layers[layer].values).layers;
        this.setPerFace('state', (face) => {
            if (this.kept && !this.kept.has(this.page.region[face])) return 2;
            return layers[face] > 0 ? 0 : 1;
        });
        this.setPerFace('value', () => 0);
    }

    colour(by: Colouring, layer: number | null): void {
        const { uniforms } = this.mesh.material;
        uniforms.useValue.value = by.of === 'faces' ? 1 : 0;
        if (by.of !== 'faces') return;
        const values = layer === null ? this.page.total : this.page.layers[layer].values;
        const array = by.id === 'layers' ? values.layers : values.thickness;
        this.setPerFace('value', (face) => array[face]);
        uniforms.range.value = [by.min, by.max];
    }

    showBare(on: boolean): void {
        this.mesh.material.uniforms.showBare.value = on ? 1 : 0;
    }

    setTheme(surface: string, other: string, edge: string): void {
        this.mesh.material.uniforms.colour.value.setStyle(surface, '');
        this.mesh.material.uniforms.otherColour.value.setStyle(other, '');
        this.lines.material.color.setStyle(edge, '');
    }

    private setPerFace(name: string, valueOf: (face: number) => number): void {
        const count = this.page.faces.length / 3;
        let attribute = this.mesh.geometry.getAttribute(name) as BufferAttribute | undefined;
        if (!attribute) {
            attribute = new BufferAttribute(new Float32Array(3 * count), 1);
            this.mesh.geometry.setAttribute(name, attribute);
        }
        for (let f = 0; f < count; ++f) {
            const v = valueOf(f);
            for (let c = 0; c < 3; ++c) attribute.array[3 * f + c] = v;
        }
        attribute.needsUpdate = true;
    }
}

/** Normals of faces, n x 3; length: twice the area. */
function faceNormals(points: Float32Array, faces: Uint32Array): Float32Array {
    const normals = new Float32Array(faces.length);
    for (let f = 0; f < faces.length; f += 3) {
        const [a, b, c] = [3 * faces[f], 3 * faces[f + 1], 3 * faces[f + 2]];
        const [ux, uy, uz] = [0, 1, 2].map((k) => points[b + k] - points[a + k]);
        const [vx, vy, vz] = [0, 1, 2].map((k) => points[c + k] - points[a + k]);
        normals[f] = uy * vz - uz * vy;
        normals[f + 1] = uz * vx - ux * vz;
        normals[f + 2] = ux * vy - uy * vx;
    }
    return normals;
}

function cosine(normals: Float32Array, f: number, g: number): number {
    const [a, b] = [3 * f, 3 * g];
    const dot = normals[a] * normals[b] + normals[a + 1] * normals[b + 1] + normals[a + 2] * normals[b + 2];
    const size =
        Math.hypot(normals[a], normals[a + 1], normals[a + 2]) *
        Math.hypot(normals[b], normals[b + 1], normals[b + 2]);
    return size > 0 ? dot / size : 1;
}

function shapeOf(
    points: Float32Array,
    faces: Uint32Array,
): { surface: BufferGeometry; edges: BufferGeometry } {
    const normals = faceNormals(points, faces);
    const positions = new Float32Array(3 * faces.length);
    for (let i = 0; i < faces.length; ++i) {
        for (let k = 0; k < 3; ++k) positions[3 * i + k] = points[3 * faces[i] + k];
    }
    const surface = new BufferGeometry();
    surface.setAttribute('position', new BufferAttribute(positions, 3));
    surface.setAttribute('normal', new BufferAttribute(cornerNormals(normals, points, faces), 3));
    const edges = new BufferGeometry();
    edges.setAttribute('position', new BufferAttribute(featureEdges(normals, points, faces), 3));
    return { surface, edges };
}

/** Per corner: the mean of the faces around its vertex that are no feature edge away. */
function cornerNormals(normals: Float32Array, points: Float32Array, faces: Uint32Array) {
    const start = new Uint32Array(points.length / 3 + 1);
    for (const v of faces) ++start[v + 1];
    for (let v = 1; v < start.length; ++v) start[v] += start[v - 1];
    const around = new Uint32Array(faces.length);
    const next = start.slice();
    for (let i = 0; i < faces.length; ++i) around[next[faces[i]]++] = Math.floor(i / 3);
    const result = new Float32Array(3 * faces.length);
    for (let i = 0; i < faces.length; ++i) {
        const f = Math.floor(i / 3);
        const sum = [0, 0, 0];
        for (let k = start[faces[i]]; k < start[faces[i] + 1]; ++k) {
            const g = around[k];
            if (g !== f && cosine(normals, f, g) < kFeatureCosine) continue;
            for (let c = 0; c < 3; ++c) sum[c] += normals[3 * g + c];
        }
        const size = Math.hypot(sum[0], sum[1], sum[2]) || 1;
        for (let c = 0; c < 3; ++c) result[3 * i + c] = sum[c] / size;
    }
    return result;
}

/** Pairs of points: rims and edges that turn by more than the feature angle. */
function featureEdges(normals: Float32Array, points: Float32Array, faces: Uint32Array) {
    const open = new Map<number, number>(); // edge to its first face
    const pairs: number[] = [];
    const count = points.length / 3;
    const keep = (a: number, b: number) => {
        for (const v of [a, b]) pairs.push(points[3 * v], points[3 * v + 1], points[3 * v + 2]);
    };
    for (let i = 0; i < faces.length; ++i) {
        const a = faces[i];
        const b = faces[i % 3 === 2 ? i - 2 : i + 1];
        const key = Math.min(a, b) * count + Math.max(a, b);
        const other = open.get(key);
        if (other === undefined) {
            open.set(key, Math.floor(i / 3));
            continue;
        }
        open.delete(key);
        if (cosine(normals, other, Math.floor(i / 3)) < kFeatureCosine) keep(a, b);
    }
    for (const key of open.keys()) keep(Math.floor(key / count), key % count);
    return new Float32Array(pairs);
}
