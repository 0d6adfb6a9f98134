/** The data of a run: header, mandrel, layers, fibres. */
import { readPayload } from './payload';
import type { PageArray } from './payload';
import type { FibreHeader, Header, LayerHeader } from './types';

const kFormat = 'meshwind-page-1';

/** One fibre with its program. Stations in winding order, blocks from the start (block 0) on. */
export interface Fibre {
    layer: number; // index from 0
    fibre: number; // index within the layer, from 0
    header: FibreHeader;
    position: Float32Array; // n x 3, mandrel frame, mm
    normal: Float32Array; // n x 3
    tangent: Float32Array; // n x 3
    s: Float32Array; // mm
    slip: Float32Array;
    bridge: Float32Array; // mm
    freeLength: Float32Array; // mm
    angle: Float32Array; // deg
    piece: Uint32Array;
    time: Float64Array; // m, s at the block's end, on the controller's clock
    asked: Float32Array; // m, s that the program asks for the block
    axes: Float64Array; // m x axes, mm or deg
    eye: Float32Array; // m x 3, mandrel frame, mm
    station: Int32Array; // m, -1: unknown
    line: Uint32Array; // m, from 1, 0: unknown
    text: Uint8Array;
}

export interface FaceValues {
    layers: Float32Array;
    thickness: Float32Array;
    angle: Float32Array;
}

export interface Layer {
    header: LayerHeader;
    points: Float32Array; // of the mandrel that this layer is wound on
    values: FaceValues;
    fibres: Fibre[];
}

/** What lies on each face of the bare mandrel, of all stages, against what was asked for there. */
export interface Wall {
    asked: Float32Array; // layers
    laid: Float32Array; // layers
    ratio: Float32Array; // laid over asked
}

export interface Page {
    header: Header;
    points: Float32Array;
    faces: Uint32Array;
    region: Int32Array;
    total: FaceValues;
    layers: Layer[];
    wall: Wall | null; // of a job that asks for a wall
    extension: { points: Float32Array; faces: Uint32Array } | null;
    array: (name: string) => PageArray;
}

/** The page's data. Throws an Error whose message can be shown. */
export async function readPage(): Promise<Page> {
    const { header, array } = await readPayload<Header>(kFormat);
    return assemble(header, array);
}

function assemble(header: Header, array: Page['array']): Page {
    const f32 = (name: string) => array(name) as Float32Array;
    const values = (prefix: string): FaceValues => ({
        layers: f32(`${prefix}/layers`),
        thickness: f32(`${prefix}/thickness_mm`),
        angle: f32(`${prefix}/angle_deg`),
    });
    const layers = header.layers.map((layer, index): Layer => ({
        header: layer,
        points: f32(layer.points),
        values: values(`layer${index + 1}`),
        fibres: layer.fibres.map((fibre, number) => fibreOf(fibre, index, number, array)),
    }));
    const extension = header.extension;
    const wall = (): Wall => {
        const [asked, laid] = [f32('wall/asked_layers'), f32('wall/laid_layers')];
        return { asked, laid, ratio: laid.map((n, face) => n / asked[face]) };
    };
    return {
        header,
        points: f32('mandrel/points'),
        faces: array('mandrel/faces') as Uint32Array,
        region: array('mandrel/region') as Int32Array,
        total: values('total'),
        layers,
        wall: header.report.walls ? wall() : null,
        extension: extension && {
            points: f32(extension.points),
            faces: array(extension.faces) as Uint32Array,
        },
        array,
    };
}

function fibreOf(header: FibreHeader, layer: number, fibre: number, array: Page['array']): Fibre {
    const of = <T>(name: string) => array(header.prefix + name) as unknown as T;
    return {
        layer,
        fibre,
        header,
        position: of<Float32Array>('position_mm'),
        normal: of<Float32Array>('normal'),
        tangent: of<Float32Array>('tangent'),
        s: of<Float32Array>('s_mm'),
        slip: of<Float32Array>('slip'),
        bridge: of<Float32Array>('bridge_mm'),
        freeLength: of<Float32Array>('free_length_mm'),
        angle: of<Float32Array>('angle_deg'),
        piece: of<Uint32Array>('piece'),
        time: of<Float64Array>('time_s'),
        asked: of<Float32Array>('asked_s'),
        axes: of<Float64Array>('axes'),
        eye: of<Float32Array>('eye_mm'),
        station: of<Int32Array>('station'),
        line: of<Uint32Array>('line'),
        text: of<Uint8Array>('text'),
    };
}
