/** A surface of triangles to be drawn: smooth between its feature edges. */
import { BufferAttribute, BufferGeometry, Vector3 } from 'three';

/** Edges that turn by more are features: lines are drawn there and shading breaks. */
const kFeatureCosine = Math.cos((30 * Math.PI) / 180);

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

/** The surface, three corners of its own to each face, and the lines of its feature edges. */
export function shapeOf(
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

/** The normal of the face whose middle is nearest to a place. */
export function nearestNormal(
    { points, faces }: { points: Float32Array; faces: Uint32Array },
    place: Vector3,
): Vector3 {
    let best = Infinity;
    let first = 0;
    for (let f = 0; f < faces.length; f += 3) {
        let distance = 0;
        for (let c = 0; c < 3; ++c) {
            const sum = points[3 * faces[f] + c] + points[3 * faces[f + 1] + c] + points[3 * faces[f + 2] + c];
            distance += (sum / 3 - place.getComponent(c)) ** 2;
        }
        if (distance < best) {
            best = distance;
            first = f;
        }
    }
    const corner = (i: number) => new Vector3().fromArray(points, 3 * faces[first + i]);
    const a = corner(0);
    return corner(1).sub(a).cross(corner(2).sub(a)).normalize();
}
