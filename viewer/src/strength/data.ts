/** The data of a wall's strength, as report/report_strength.h describes it. */
import { readPayload } from '../payload';
import type { PayloadHeader } from '../payload';
import type { Vec3 } from '../types';

const kFormat = 'meshwind-strength-1';

/** A ply at the point of it that fails first. */
export interface PlyState {
    reserve: number;
    layer: number;
    shell: number;
    ply: number;
    position_mm: Vec3;
    angle_deg: number;
    stress_MPa: { along: number; across: number; shear: number };
}

interface Strength {
    meshwind: string;
    material: string;
    loads: { pressure_MPa: number; axial_N: number; moment_Nmm: Vec3 };
    shells: number;
    bare: number;
    plies: { laid: number; computed: number; most: number };
    first_failure: PlyState | null;
    reserve_of_99_percent: number | null;
    layers: (PlyState | null)[];
}

interface Header extends PayloadHeader {
    strength: Strength;
    text: string;
    name: string;
}

export interface Wall {
    header: Header;
    strength: Strength;
    points: Float32Array;
    faces: Uint32Array;
    utilisation: Float32Array; // per triangle: load over that at which its first ply fails
    thickness: Float32Array; // mm
    plies: Int32Array;
}

/** Throws an Error whose message can be shown. */
export async function readWall(): Promise<Wall> {
    const { header, array } = await readPayload<Header>(kFormat);
    return {
        header,
        strength: header.strength,
        points: array('wall/points') as Float32Array,
        faces: array('wall/faces') as Uint32Array,
        utilisation: array('wall/utilisation') as Float32Array,
        thickness: array('wall/thickness') as Float32Array,
        plies: array('wall/plies') as Int32Array,
    };
}
