/** The part's triangles, coloured by what they are taken for. */
import {
    BufferAttribute,
    BufferGeometry,
    Color,
    DoubleSide,
    Group,
    LineSegments,
    Mesh,
    ShaderMaterial,
} from 'three';
import { shapeOf } from '../shape';
import { cssVariable } from '../theme';
import type { Part } from './data';
import { colourOf, kDetails, kSharp } from './kinds';
import type { Colours } from './kinds';
import { kLineFragment, kLineVertex, kPartFragment, kPartVertex } from './shaders';

export class Body {
    readonly group = new Group();
    readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
    readonly details: Mesh<BufferGeometry, ShaderMaterial>;
    private readonly lines: LineSegments<BufferGeometry, ShaderMaterial>;
    // Shared by the three, so that one change holds for all.
    private readonly uniforms = {
        cut: { value: 0 },
        triangles: { value: 0 },
        chosen: { value: -1 },
        sky: { value: new Color() },
        line: { value: new Color() },
        sharpColour: { value: new Color().setStyle(kSharp, '') },
    };

    constructor(private readonly part: Part) {
        const shape = shapeOf(part.points, part.faces);
        this.mesh = this.meshOf(shape.surface, 0);
        this.perFace('region', Float32Array, 1, (face) => [part.region[face]]);
        this.perFace('sharp', Uint8Array, 1, (face) => [part.sharp[face]]);
        this.lines = new LineSegments(
            shape.edges,
            new ShaderMaterial({
                vertexShader: kLineVertex,
                fragmentShader: kLineFragment,
                uniforms: this.uniforms,
            }),
        );
        // What was taken off stands a little out of the wall or in it: drawn over it, front side alone.
        const details = shapeOf(part.details.points, part.details.faces).surface;
        const corners = part.details.faces.length;
        const tint = new Uint8Array(3 * corners).map((_, i) => kDetails.rgb[i % 3]);
        details.setAttribute('tint', new BufferAttribute(tint, 3, true));
        details.setAttribute('region', new BufferAttribute(new Float32Array(corners).fill(-2), 1));
        details.setAttribute('sharp', new BufferAttribute(new Uint8Array(corners), 1));
        this.details = this.meshOf(details, 2 * part.header.details_mm);
        this.details.visible = corners > 0;
        this.group.add(this.mesh, this.details, this.lines);
        this.colour('kind');
    }

    colour(by: Colours): void {
        const colours = this.part.inspected.regions.map((r) => colourOf(r, by));
        this.perFace('tint', Uint8Array, 3, (face) => colours[this.part.region[face]]);
    }

    setTheme(): void {
        this.uniforms.sky.value.setStyle(cssVariable('--sky'), '');
        this.uniforms.line.value.setStyle(cssVariable('--mandrel-edge'), '');
    }

    cutOpen(on: boolean): void {
        this.uniforms.cut.value = on ? 1 : 0;
    }

    isCut(): boolean {
        return this.uniforms.cut.value > 0;
    }

    showTriangles(on: boolean): void {
        this.uniforms.triangles.value = on ? 1 : 0;
    }

    /** Pales all but one region; null: none. */
    choose(region: number | null): void {
        this.uniforms.chosen.value = region ?? -1;
    }

    private meshOf(geometry: BufferGeometry, lift: number): Mesh<BufferGeometry, ShaderMaterial> {
        const material = new ShaderMaterial({
            vertexShader: kPartVertex,
            fragmentShader: kPartFragment,
            uniforms: { ...this.uniforms, lift: { value: lift }, frontOnly: { value: lift > 0 ? 1 : 0 } },
            side: DoubleSide,
            polygonOffset: true,
            polygonOffsetFactor: 1,
            polygonOffsetUnits: 1,
        });
        return new Mesh(geometry, material);
    }

    private perFace(
        name: string,
        Type: typeof Uint8Array | typeof Float32Array,
        width: number,
        entriesOf: (face: number) => number[],
    ): void {
        const count = this.part.faces.length / 3;
        const values = new Type(3 * width * count);
        for (let f = 0; f < count; ++f) {
            const entries = entriesOf(f);
            for (let c = 0; c < 3; ++c) values.set(entries, width * (3 * f + c));
        }
        // Colours are bytes that stand for 0..1.
        this.mesh.geometry.setAttribute(name, new BufferAttribute(values, width, width === 3));
    }
}
