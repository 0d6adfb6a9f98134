/** Reads the data block of the page: base64 of gzip of a header and its arrays. */
import { gunzipSync } from 'three/examples/jsm/libs/fflate.module.js';
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
    time: Float64Array; // m, s at the block's end
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

export interface Page {
    header: Header;
    points: Float32Array;
    faces: Uint32Array;
    region: Int32Array;
    total: FaceValues;
    layers: Layer[];
    extension: { points: Float32Array; faces: Uint32Array } | null;
    array: (name: string) => Float32Array | Uint32Array | Float64Array | Int32Array | Uint8Array;
}

function bytesOfBase64(text: string): Uint8Array {
    const binary = atob(text);
    const bytes = new Uint8Array(binary.length);
    for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
    return bytes;
}

async function gunzip(packed: Uint8Array): Promise<Uint8Array> {
    if (typeof DecompressionStream === 'undefined') return gunzipSync(packed);
    const stream = new Blob([packed as BlobPart]).stream();
    const plain = stream.pipeThrough(new DecompressionStream('gzip'));
    return new Uint8Array(await new Response(plain).arrayBuffer());
}

const kTypes = {
    f32: Float32Array,
    f64: Float64Array,
    u32: Uint32Array,
    i32: Int32Array,
    u8: Uint8Array,
};

/** The page's data. Throws an Error whose message can be shown. */
export async function readPage(): Promise<Page> {
    const element = document.getElementById('meshwind-data');
    if (!element) throw new Error('This page has no data: it is the empty template.');
    const bytes = await gunzip(bytesOfBase64((element.textContent ?? '').trim()));
    element.remove(); // the text is as large as all else together
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const length = view.getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length))) as Header;
    if (header.format !== kFormat) {
        throw new Error(`The data is of format "${header.format}"; this page reads "${kFormat}".`);
    }
    const base = bytes.byteOffset + 4 + length;
    const array = (name: string) => {
        const place = header.arrays[name];
        if (!place) throw new Error(`The data has no array "${name}".`);
        const Type = kTypes[place.type];
        const start = base + place.offset;
        const size = place.count * place.width;
        return start % Type.BYTES_PER_ELEMENT === 0
            ? new Type(bytes.buffer as ArrayBuffer, start, size)
            : new Type(bytes.slice(start - bytes.byteOffset).buffer, 0, size);
    };
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
    return {
        header,
        points: f32('mandrel/points'),
        faces: array('mandrel/faces') as Uint32Array,
        region: array('mandrel/region') as Int32Array,
        total: values('total'),
        layers,
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
        axes: of<Float64Array>('axes'),
        eye: of<Float32Array>('eye_mm'),
        station: of<Int32Array>('station'),
        line: of<Uint32Array>('line'),
        text: of<Uint8Array>('text'),
    };
}
