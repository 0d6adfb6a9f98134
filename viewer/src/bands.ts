/** One fibre as a flat band of its true width, in winding order. */
import {
    BufferAttribute,
    BufferGeometry,
    Color,
    DoubleSide,
    Int8BufferAttribute,
    Mesh,
    ShaderMaterial,
} from 'three';
import { categoryTexture, kOverLimit, sequentialTexture } from './colour';
import type { Colouring, ColouringId } from './colour';
import type { Fibre } from './data';
import { kBandFragment, kBandVertex } from './shaders';

const kIndicesPerStep = 6;
/** Of the band's width: how far towards the viewer it is drawn, against dipping into hollows. */
const kLiftOfWidth = 0.2;
/** Steps longer than so many widths are gaps between pieces, not fibre. */
const kGapWidths = 12;

export class Bands {
    readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
    private readonly values: Float32Array;

    constructor(
        readonly fibre: Fibre,
        widthMm: number,
        order: number,
    ) {
        const n = fibre.s.length;
        this.values = new Float32Array(2 * n);
        const material = new ShaderMaterial({
            vertexShader: kBandVertex,
            fragmentShader: kBandFragment,
            uniforms: {
                map: { value: sequentialTexture },
                range: { value: [0, 1] },
                categories: { value: 0 },
                hasLimit: { value: 0 },
                noneColour: { value: new Color().setStyle('#9aa3ad', '') },
                overColour: { value: new Color().setStyle(kOverLimit, '') },
                lift: { value: kLiftOfWidth * widthMm },
            },
            side: DoubleSide,
            depthWrite: false,
            clipping: true,
        });
        this.mesh = new Mesh(bandGeometry(fibre, widthMm, this.values), material);
        this.mesh.frustumCulled = false;
        this.mesh.renderOrder = 10 + order;
    }

    /** Shows the fibre from a station to another. */
    show(from: number, to: number): void {
        const step = (station: number): number =>
            Math.min(Math.max(Math.ceil(station - 1e-6), 0), this.fibre.s.length - 1);
        const steps = Math.max(step(to) - step(from), 0);
        this.mesh.geometry.setDrawRange(step(from) * kIndicesPerStep, steps * kIndicesPerStep);
        this.mesh.visible = steps > 0;
    }

    colour(by: Colouring): void {
        if (by.perFace) return;
        const { fibre, values } = this;
        const pieces = fibre.header.pieces;
        const ofPiece = (i: number) => pieces[fibre.piece[i]];
        const valuesOf: Partial<Record<ColouringId, (i: number) => number>> = {
            course: (i: number) => (ofPiece(i)?.kind === 'course' ? ofPiece(i).course : -1),
            family: (i: number) => ofPiece(i)?.family ?? -1,
            slip: (i: number) => fibre.slip[i],
            bridging: (i: number) => fibre.bridge[i],
            angle: (i: number) => fibre.angle[i],
        };
        const valueAt = valuesOf[by.id] ?? (() => 0);
        for (let i = 0; i < fibre.s.length; ++i) values[2 * i] = values[2 * i + 1] = valueAt(i);
        this.mesh.geometry.getAttribute('value').needsUpdate = true;
        const { uniforms } = this.mesh.material;
        const categories = by.kind === 'categories';
        uniforms.map.value = categories ? categoryTexture : sequentialTexture;
        uniforms.categories.value = categories ? categoryTexture.image.width : 0;
        uniforms.range.value = [by.min, by.max];
        uniforms.hasLimit.value = by.limit === null ? 0 : 1;
    }
}

function bandGeometry(fibre: Fibre, width: number, values: Float32Array): BufferGeometry {
    const n = fibre.s.length;
    const half = width / 2;
    const positions = new Float32Array(6 * n);
    const normals = new Int8Array(8 * n); // four bytes each, so that rows stay aligned
    const across = new Int8Array(2 * n);
    const { position: p, normal: m, tangent: t } = fibre;
    for (let i = 0; i < n; ++i) {
        const k = 3 * i;
        const side = [
            m[k + 1] * t[k + 2] - m[k + 2] * t[k + 1],
            m[k + 2] * t[k] - m[k] * t[k + 2],
            m[k] * t[k + 1] - m[k + 1] * t[k],
        ];
        for (let c = 0; c < 3; ++c) {
            positions[6 * i + c] = p[k + c] - half * side[c];
            positions[6 * i + 3 + c] = p[k + c] + half * side[c];
            normals[8 * i + c] = normals[8 * i + 4 + c] = Math.round(127 * m[k + c]);
        }
        across[2 * i] = -127;
        across[2 * i + 1] = 127;
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setAttribute('normal', new BufferAttribute(normals, 4, true));
    geometry.setAttribute('across', new Int8BufferAttribute(across, 1, true));
    geometry.setAttribute('value', new BufferAttribute(values, 1));
    geometry.setIndex(new BufferAttribute(stripIndices(fibre, width), 1));
    return geometry;
}

function stripIndices(fibre: Fibre, width: number): Uint32Array {
    const n = fibre.s.length;
    const indices = new Uint32Array(kIndicesPerStep * Math.max(n - 1, 0));
    const p = fibre.position;
    for (let i = 0; i + 1 < n; ++i) {
        const k = 3 * i;
        const step = Math.hypot(p[k + 3] - p[k], p[k + 4] - p[k + 1], p[k + 5] - p[k + 2]);
        if (step > kGapWidths * width) continue; // all zero: no triangle
        const a = 2 * i;
        indices.set([a, a + 2, a + 1, a + 1, a + 2, a + 3], kIndicesPerStep * i);
    }
    return indices;
}
