/** The machine: what moves with the eye, what stands, and the free fibre. */
import {
    BufferAttribute,
    BufferGeometry,
    CapsuleGeometry,
    Color,
    DoubleSide,
    Group,
    Line,
    LineBasicMaterial,
    Matrix4,
    Mesh,
    Quaternion,
    ShaderMaterial,
    SphereGeometry,
    Vector3,
} from 'three';
import type { Page } from './data';
import type { Pose } from './kinematics';
import { kBodyFragment, kBodyVertex } from './shaders';
import type { Landing } from './timeline';
import type { Body, Machine } from './types';

/** \param ambient how light it is on its dark side, 0..1 */
export function bodyMaterial(ambient = 0.45): ShaderMaterial {
    return new ShaderMaterial({
        vertexShader: kBodyVertex,
        fragmentShader: kBodyFragment,
        uniforms: { colour: { value: new Color() }, ambient: { value: ambient } },
        side: DoubleSide,
        clipping: true,
    });
}

/** A mesh given by arrays of the page. */
export function meshGeometry(points: Float32Array, faces: Uint32Array): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(points, 3));
    geometry.setIndex(new BufferAttribute(faces, 1));
    geometry.computeVertexNormals();
    return geometry;
}

export class MachineView {
    readonly group = new Group();
    readonly fibre = new Group(); // free fibre and eye, base frame
    private readonly links = new Map<string, Group>();
    private readonly material = bodyMaterial();
    private readonly eyeMaterial = bodyMaterial();
    private readonly eye: Mesh;
    private readonly ribbon: Mesh<BufferGeometry, ShaderMaterial>;
    private readonly line: Line<BufferGeometry, LineBasicMaterial>;

    constructor(
        private readonly page: Page,
        machine: Machine,
        private readonly widthMm: number,
    ) {
        for (const body of [...machine.eye.envelope, ...machine.bodies]) this.add(body);
        this.eye = new Mesh(new SphereGeometry(Math.max(1.2, widthMm * 0.3), 20, 14), this.eyeMaterial);
        this.ribbon = new Mesh(new BufferGeometry(), bodyMaterial(0.85));
        this.ribbon.geometry.setAttribute('position', new BufferAttribute(new Float32Array(12), 3));
        this.ribbon.geometry.setAttribute('normal', new BufferAttribute(new Float32Array(12), 3));
        this.ribbon.geometry.setIndex([0, 1, 2, 2, 1, 3]);
        this.line = new Line(new BufferGeometry(), new LineBasicMaterial());
        this.line.geometry.setAttribute('position', new BufferAttribute(new Float32Array(6), 3));
        for (const part of [this.eye, this.ribbon, this.line]) {
            part.frustumCulled = false;
            part.renderOrder = 900; // over the bands, which leave no depth behind
        }
        this.fibre.add(this.eye, this.ribbon, this.line);
    }

    setTheme(body: string, eye: string, fibre: string): void {
        this.material.uniforms.colour.value.setStyle(body, '');
        this.eyeMaterial.uniforms.colour.value.setStyle(eye, '');
        this.ribbon.material.uniforms.colour.value.setStyle(fibre, '');
        this.line.material.color.setStyle(fibre, '');
    }

    /** Moves the links, the eye and the free fibre; `landing` is in the mandrel frame. */
    update(pose: Pose, landing: Landing | null): void {
        for (const [letter, group] of this.links) {
            const matrix = letter ? pose.links.get(letter) : undefined;
            group.matrix.copy(matrix ?? new Matrix4());
            group.matrixWorldNeedsUpdate = true;
        }
        this.eye.position.copy(pose.eyeBase);
        this.ribbon.visible = this.line.visible = landing !== null;
        if (landing) this.lay(pose, landing);
    }

    private lay(pose: Pose, landing: Landing): void {
        const from = landing.point.clone().applyMatrix4(pose.baseFromMandrel);
        const side = landing.normal.clone().cross(landing.tangent);
        side.transformDirection(pose.baseFromMandrel).multiplyScalar(this.widthMm / 2);
        const roller = pose.rollerBase.clone().multiplyScalar(this.widthMm / 2);
        if (roller.dot(side) < 0) roller.negate();
        const to = pose.eyeBase;
        const corners = [
            from.clone().sub(side),
            from.clone().add(side),
            to.clone().sub(roller),
            to.clone().add(roller),
        ];
        const normal = to.clone().sub(from).cross(side).normalize();
        const position = this.ribbon.geometry.getAttribute('position') as BufferAttribute;
        const normals = this.ribbon.geometry.getAttribute('normal') as BufferAttribute;
        corners.forEach((c, i) => {
            position.setXYZ(i, c.x, c.y, c.z);
            normals.setXYZ(i, normal.x, normal.y, normal.z);
        });
        position.needsUpdate = normals.needsUpdate = true;
        const line = this.line.geometry.getAttribute('position') as BufferAttribute;
        line.setXYZ(0, from.x, from.y, from.z);
        line.setXYZ(1, to.x, to.y, to.z);
        line.needsUpdate = true;
    }

    private add(body: Body): void {
        const letter = body.link ?? '';
        let group = this.links.get(letter);
        if (!group) {
            group = new Group();
            group.matrixAutoUpdate = false;
            this.links.set(letter, group);
            this.group.add(group);
        }
        if (body.type === 'mesh') {
            const points = this.page.array(body.points) as Float32Array;
            const faces = this.page.array(body.faces) as Uint32Array;
            group.add(new Mesh(meshGeometry(points, faces), this.material));
            return;
        }
        const from = new Vector3(...body.from);
        const to = new Vector3(...body.to);
        const along = to.clone().sub(from);
        const mesh = new Mesh(new CapsuleGeometry(body.radius, along.length(), 10, 28, 1), this.material);
        mesh.position.copy(from).add(to).multiplyScalar(0.5);
        mesh.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), along.normalize()));
        group.add(mesh);
    }
}
