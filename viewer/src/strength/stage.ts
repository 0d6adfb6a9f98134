/** The picture of a wall: its triangles by a value, and labels at its weakest plies. */
import { BufferAttribute, Color, DoubleSide, LineSegments, Mesh, Raycaster, ShaderMaterial, Vector2, Vector3 } from 'three';
import type { BufferGeometry } from 'three';
import { Labels } from '../part/labels';
import type { Label } from '../part/labels';
import { kLineFragment, kLineVertex, kPartFragment, kPartVertex } from '../part/shaders';
import { kCloseShare, kFirstView, kUp, someOf } from '../part/stage';
import { View } from '../scene';
import { nearestNormal, shapeOf } from '../shape';
import { cssVariable } from '../theme';
import { colourOfValue } from './colourings';
import type { Colouring } from './colourings';
import type { Wall } from './data';

export class WallStage {
    readonly view: View;
    readonly labels: Labels;
    private readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
    private readonly caster = new Raycaster();
    private readonly size: number;
    private readonly uniforms = {
        cut: { value: 0 },
        triangles: { value: 0 },
        chosen: { value: -1 },
        lift: { value: 0 },
        frontOnly: { value: 0 },
        sky: { value: new Color() },
        line: { value: new Color() },
        sharpColour: { value: new Color() },
    };

    constructor(
        private readonly wall: Wall,
        canvas: HTMLCanvasElement,
        labelHost: HTMLElement,
    ) {
        this.view = new View(canvas, kUp);
        const shape = shapeOf(wall.points, wall.faces);
        for (const name of ['region', 'sharp']) {
            shape.surface.setAttribute(name, new BufferAttribute(new Float32Array(wall.faces.length), 1));
        }
        this.mesh = new Mesh(
            shape.surface,
            new ShaderMaterial({
                vertexShader: kPartVertex,
                fragmentShader: kPartFragment,
                uniforms: this.uniforms,
                side: DoubleSide,
                polygonOffset: true,
                polygonOffsetFactor: 1,
                polygonOffsetUnits: 1,
            }),
        );
        const lines = new ShaderMaterial({
            vertexShader: kLineVertex,
            fragmentShader: kLineFragment,
            uniforms: this.uniforms,
        });
        this.view.world.add(this.mesh, new LineSegments(shape.edges, lines));
        shape.surface.computeBoundingBox();
        const box = shape.surface.boundingBox;
        this.size = box ? box.max.distanceTo(box.min) : 1;
        this.labels = new Labels(labelHost, this.labelsOf());
        this.view.afterRender = () => this.labels.place(this.view.camera);
        this.setTheme();
    }

    setTheme(): void {
        this.view.setBackground(cssVariable('--sky'));
        this.uniforms.sky.value.setStyle(cssVariable('--sky'), '');
        this.uniforms.line.value.setStyle(cssVariable('--mandrel-edge'), '');
        this.view.request();
    }

    colour(by: Colouring): void {
        const tint = new Uint8Array(9 * by.values.length);
        for (let f = 0; f < by.values.length; ++f) {
            const colour = colourOfValue(by, by.values[f]);
            for (let c = 0; c < 3; ++c) tint.set(colour, 9 * f + 3 * c);
        }
        this.mesh.geometry.setAttribute('tint', new BufferAttribute(tint, 3, true));
        this.view.request();
    }

    cutOpen(on: boolean): void {
        this.uniforms.cut.value = on ? 1 : 0;
        this.view.request();
    }

    showTriangles(on: boolean): void {
        this.uniforms.triangles.value = on ? 1 : 0;
        this.view.request();
    }

    showMarks(on: boolean): void {
        this.labels.show(on);
        this.view.request();
    }

    fit(): void {
        this.view.resize();
        this.view.fit(someOf(this.wall.points), kFirstView);
    }

    flyTo(label: Label): void {
        const direction = label.normal?.clone() ?? label.at.clone();
        direction.addScaledVector(kUp, 0.25).normalize();
        this.view.flyTo(label.at, direction, kCloseShare * this.size);
    }

    /** The triangle under the pointer. \param at -1..1 both ways */
    pick(at: Vector2): number | null {
        this.view.world.updateMatrixWorld();
        this.caster.setFromCamera(at, this.view.camera);
        const cut = this.uniforms.cut.value > 0;
        const hit = this.caster.intersectObject(this.mesh, false).find((h) => !cut || h.point.y <= 0);
        return hit?.faceIndex ?? null;
    }

    private labelsOf(): Label[] {
        const labels: Label[] = [];
        for (const state of this.wall.strength.layers) {
            if (!state) continue;
            const at = new Vector3(...state.position_mm);
            labels.push({
                id: `layer-${state.layer}`,
                kind: 'remark',
                words: `layer ${state.layer}`,
                title: `Weakest place of layer ${state.layer}`,
                at,
                normal: nearestNormal(this.wall, at),
            });
        }
        return labels;
    }
}
