/** The data of a part, as report/part_data.h describes it. */
import { readPayload } from '../payload';
import type { PayloadHeader } from '../payload';
import type { Vec3 } from '../types';

const kFormat = 'meshwind-part-1';

export interface Region {
    id: number;
    kind: string;
    kept: boolean;
    triangles: number; // of the file
    area_mm2: number;
    visible_fraction: number;
}

export interface Rim {
    id: number;
    centre: Vec3;
    axis: Vec3;
    radius: number;
    circularity_mm: number;
    cut_off_mm: number;
}

/** A line that the part might turn about; the first is the one that was chosen. */
export interface AxisCandidate {
    rule: string;
    through: Vec3;
    direction: Vec3;
    swing_mm: number;
    rims: number;
    gap_deg: number;
    angle_deg: number;
    off_mm: number;
    why: string;
}

export interface Inspected {
    file: string;
    unit_mm: number;
    unit_rule: string;
    file_triangles: number;
    file_to_mandrel: number[][];
    regions: Region[];
    rims: Rim[];
    area_mm2: number;
    axis: { rule: string; candidates: AxisCandidate[] };
    remarks: string[];
    places: { remark: number; at: Vec3 }[];
    winding_mesh: { own: boolean; details: number; details_mm2: number };
}

interface Header extends PayloadHeader {
    inspection: { meshwind: string; mandrel: Inspected };
    text: string;
    refused: string | null;
    tow_width_mm: number;
    details_mm: number;
}

export interface Part {
    header: Header;
    inspected: Inspected;
    points: Float32Array;
    faces: Uint32Array;
    region: Int32Array;
    sharp: Uint8Array;
    details: { points: Float32Array; faces: Uint32Array };
    loops: Float32Array[]; // of each rim
}

/** Throws an Error whose message can be shown. */
export async function readPart(): Promise<Part> {
    const { header, array } = await readPayload<Header>(kFormat);
    const inspected = header.inspection.mandrel;
    return {
        header,
        inspected,
        points: array('part/points') as Float32Array,
        faces: array('part/faces') as Uint32Array,
        region: array('part/region') as Int32Array,
        sharp: array('part/sharp') as Uint8Array,
        details: {
            points: array('details/points') as Float32Array,
            faces: array('details/faces') as Uint32Array,
        },
        loops: inspected.rims.map((rim) => array(`rim${rim.id}/loop`) as Float32Array),
    };
}

export function faceArea(points: Float32Array, faces: Uint32Array, face: number): number {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * faces[3 * face + k]);
    const u = [0, 1, 2].map((k) => points[b + k] - points[a + k]);
    const v = [0, 1, 2].map((k) => points[c + k] - points[a + k]);
    return (
        Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2
    );
}
