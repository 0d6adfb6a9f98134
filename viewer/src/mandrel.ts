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
import type { Material } from 'three';
import { kBare, sequentialTexture } from './colour';
import type { Colouring } from './colour';
import type { Page } from './data';
import { kMandrelFragment, kMandrelVertex } from './shaders';
import { shapeOf } from './shape';

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
            clipping: true,
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

    colour(by: Colouring): void {
        const { uniforms } = this.mesh.material;
        const values = by.perFace;
        uniforms.useValue.value = values ? 1 : 0;
        if (!values) return;
        this.setPerFace('value', (face) => values[face]);
        uniforms.range.value = [by.min, by.max];
    }

    /** What draws it. */
    materials(): Material[] {
        return [this.mesh.material, this.lines.material];
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
