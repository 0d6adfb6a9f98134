/** A plane square to an axis of the mandrel: what lies beyond it is cut away. */
import { Box3, Plane, Vector3 } from 'three';
import type { Material, Matrix4 } from 'three';

export type SectionAxis = 'x' | 'y' | 'z';

export class Section {
    axis: SectionAxis | null = null; // null: nothing is cut
    private at = 0; // mm along the axis
    private readonly world = new Plane();

    /** \param extent of what may be cut, mandrel frame */
    constructor(
        private readonly extent: Box3,
        private readonly materials: Material[],
    ) {}

    /** Cuts in the middle, or nothing. */
    choose(axis: SectionAxis | null): void {
        this.axis = axis;
        if (axis) this.at = (this.extent.min[axis] + this.extent.max[axis]) / 2;
        for (const material of this.materials) material.clippingPlanes = axis ? [this.world] : null;
    }

    moveTo(mm: number): void {
        this.at = mm;
    }

    /** From where to where the plane can be moved, and where it is; mm along its axis. */
    travel(): { from: number; to: number; at: number } {
        const axis = this.axis ?? 'x';
        return { from: this.extent.min[axis], to: this.extent.max[axis], at: this.at };
    }

    /** \param worldFromMandrel where the mandrel is drawn */
    place(worldFromMandrel: Matrix4): void {
        if (!this.axis) return;
        this.world.setComponents(0, 0, 0, this.at);
        this.world.normal[this.axis] = -1;
        this.world.applyMatrix4(worldFromMandrel);
    }

    /** Whether a place (world frame) is left. */
    keeps(place: Vector3): boolean {
        return this.axis === null || this.world.distanceToPoint(place) >= 0;
    }
}
