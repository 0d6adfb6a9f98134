/** What the data block of a page holds. Lengths mm, angles deg, times s, as in the program's files. */

export type Vec3 = [number, number, number];

export interface Place {
    position_mm?: Vec3; // mandrel frame
    block?: number;
    layer?: number; // from 1
    fibre?: number; // from 1
}

export interface Check {
    ok: boolean;
    words?: string;
    place?: Place;
    [number: string]: unknown;
}

export interface Measure {
    key: string; // of the check
    label?: string;
    limit?: string | number; // key of the check, or a number that is always the limit
    least?: boolean; // the value must not be below
}

/** What the checks of one name have in common. */
export interface CheckKind {
    title: string;
    measures: Measure[];
}

export interface Uncovered {
    area_mm2: number;
    reason: string;
    region: number;
}

export interface Plan {
    courses?: number;
    transitions?: number;
    fibre_length_mm?: number;
    coverage?: { fraction?: number; mean_layers?: number; max_layers?: number; p1_layers?: number };
    fibre_factor?: number;
    turn_share?: number;
    uncovered?: Uncovered[];
    planner?: string;
    asked_angle_deg?: number;
    angles?: { mean_deg?: number };
    pattern?: { circuits?: number; starts?: number; dwell_deg?: number };
}

/** What layers are made of, one or all together. */
export interface Laminate {
    fibre_m?: number;
    mass_g?: number;
    time_s?: number;
    thickness_mm?: { mean: number; max: number };
}

export interface LayerReport extends Laminate {
    layer: number;
    kind: string;
    mandrel?: string;
    goes_on?: boolean;
    cut_because?: string;
    angle_deg?: number | null;
    plan?: Plan;
}

/** A layer of the job that was wound in stages. Ratios are of what lies there over what was asked for. */
export interface WallReport {
    first_layer: number;
    last_layer: number;
    asked_layers: number; // on average
    reachable: number; // share of the wall
    below: number; // share of that
    mean_over_asked: number;
    p1_over_asked: number;
    cv: number;
    fibre_m: number;
    turn_share: number;
    fibre_factor: number;
    bound?: { least_factor: number; gap: number };
    thin: { region: number; below: number; lacks_mm: number }[];
}

/** What the run was asked for. */
export interface RunReport {
    job?: Record<string, unknown>; // what differs from the defaults
    seed?: number;
    effort?: number;
}

export interface Report {
    meshwind?: string;
    machine?: string;
    ok?: boolean;
    mandrel?: {
        file?: string;
        area_mm2?: number;
        triangles?: number;
        regions?: { id: number; kept: boolean; kind: string; area_mm2: number }[];
    };
    plan?: Plan;
    checks?: Record<string, Check>;
    program?: { blocks?: number; duration_s?: number; dialect?: string };
    laminate?: Laminate;
    cost?: { fibre_m?: number; mass_g?: number; time_s?: number };
    layers?: LayerReport[];
    run?: RunReport;
    walls?: WallReport[];
}

export interface Axis {
    letter: string;
    type: 'linear' | 'rotary';
    direction: Vec3;
    point: Vec3;
    min: number | null;
    max: number | null;
    velocity: number | null;
    acceleration: number | null;
}

export interface Capsule {
    type: 'capsule';
    link: string | null;
    from: Vec3;
    to: Vec3;
    radius: number;
}

export interface BodyMesh {
    type: 'mesh';
    link: string | null;
    points: string;
    faces: string;
}

export type Body = Capsule | BodyMesh;

export interface Machine {
    name: string;
    mandrel_chain: Axis[];
    eye_chain: Axis[];
    mount: { origin: Vec3; x: Vec3; z: Vec3 } | null;
    up: Vec3;
    eye: { position: Vec3; roller: Vec3; exit: Vec3; envelope: Body[] };
    bodies: Body[];
    fibre: { min_free_length: number; max_free_length: number; max_speed: number };
}

export interface Piece {
    kind: 'course' | 'transition';
    course: number;
    family: number;
    first: number;
    count: number;
    length_mm: number;
    worst_slip: number;
    start_rim: number;
    end_rim: number;
    layer_angle_deg?: number | null;
}

export interface FibreHeader {
    program: string | null;
    dialect: string;
    prefix: string;
    pieces: Piece[];
    shortened?: string; // what the page leaves out
    block_every?: number; // one block in so many is in the page
}

export interface LayerHeader {
    name: string;
    kind: string;
    points: string;
    fibres: FibreHeader[];
}

export interface ArrayPlace {
    type: 'f32' | 'f64' | 'u32' | 'i32' | 'u8';
    width: number;
    count: number;
    offset: number;
}

export interface Header {
    format: string;
    report: Report;
    check_kinds: Record<string, CheckKind>; // by name without layer and fibre
    machine: Machine;
    tow: { width_mm: number; thickness_mm: number; friction: number };
    extension: { points: string; faces: string } | null;
    layers: LayerHeader[];
    arrays: Record<string, ArrayPlace>;
}
