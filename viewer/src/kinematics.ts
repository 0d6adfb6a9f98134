/** Where the axes bring mandrel, eye and links: products of exponentials, base frame, mm and deg. */
import { Matrix4, Vector3 } from 'three';
import type { Axis, Machine, Vec3 } from './types';

const kDegree = Math.PI / 180;

/** Motion of one axis: along its direction, or right-handed about the line through its point. */
function exponential(axis: Axis, q: number, out: Matrix4): Matrix4 {
    const direction = new Vector3(...axis.direction);
    if (axis.type === 'linear') {
        return out.makeTranslation(direction.x * q, direction.y * q, direction.z * q);
    }
    const point = new Vector3(...axis.point);
    out.makeRotationAxis(direction, q * kDegree);
    const shift = point.clone().sub(point.clone().applyMatrix4(out));
    return out.setPosition(shift);
}

export interface Pose {
    baseFromMandrel: Matrix4;
    baseFromEyeLink: Matrix4; // after all axes of the eye's chain
    links: Map<string, Matrix4>; // what is given "at zero" on this axis, to where it is
    eyeBase: Vector3;
    eyeMandrel: Vector3;
    rollerBase: Vector3; // unit
}

export class Kinematics {
    readonly axes: Axis[];
    private readonly mount = new Matrix4();

    constructor(readonly machine: Machine) {
        this.axes = [...machine.mandrel_chain, ...machine.eye_chain];
        if (machine.mount) {
            const x = new Vector3(...machine.mount.x);
            const z = new Vector3(...machine.mount.z);
            const y = z.clone().cross(x);
            this.mount.makeBasis(x, y, z).setPosition(new Vector3(...machine.mount.origin));
        }
    }

    /** \param q values of all axes, mandrel chain first */
    pose(q: ArrayLike<number>): Pose {
        const links = new Map<string, Matrix4>();
        const step = new Matrix4();
        const chain = (axes: Axis[], first: number): Matrix4 => {
            const product = new Matrix4();
            axes.forEach((axis, i) => {
                product.multiply(exponential(axis, q[first + i], step));
                links.set(axis.letter, product.clone());
            });
            return product;
        };
        const mandrelCount = this.machine.mandrel_chain.length;
        const baseFromMandrel = chain(this.machine.mandrel_chain, 0).multiply(this.mount);
        const baseFromEyeLink = chain(this.machine.eye_chain, mandrelCount);
        const eyeBase = new Vector3(...this.machine.eye.position).applyMatrix4(baseFromEyeLink);
        const mandrelFromBase = baseFromMandrel.clone().invert();
        return {
            baseFromMandrel,
            baseFromEyeLink,
            links,
            eyeBase,
            eyeMandrel: eyeBase.clone().applyMatrix4(mandrelFromBase),
            rollerBase: new Vector3(...this.machine.eye.roller).transformDirection(baseFromEyeLink),
        };
    }

    /** Turn of the mandrel about its own axis that the last rotary axis of its chain makes, deg. */
    spindle(q: ArrayLike<number>): number {
        const chain = this.machine.mandrel_chain;
        for (let i = chain.length - 1; i >= 0; --i) {
            if (chain[i].type !== 'rotary') continue;
            const z: Vec3 = this.machine.mount?.z ?? [0, 0, 1];
            const d = chain[i].direction;
            return q[i] * Math.sign(d[0] * z[0] + d[1] * z[1] + d[2] * z[2] || 1);
        }
        return 0;
    }

    /** Which way is up on the screen: as a machine with one spindle has it; arms stand on z. */
    up(): Vector3 {
        const rotary = this.machine.mandrel_chain.filter((axis) => axis.type === 'rotary');
        const alongZ = rotary.length > 0 && Math.abs(rotary[0].direction[2]) > 0.99;
        const spindle = alongZ && rotary.length === 1;
        return spindle ? new Vector3(...this.machine.up) : new Vector3(0, 0, 1);
    }
}
