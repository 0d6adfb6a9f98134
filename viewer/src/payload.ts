/** Reads the data block of a page: base64 of gzip of a header and its arrays. */
import { gunzipSync } from 'three/examples/jsm/libs/fflate.module.js';
import type { ArrayPlace } from './types';

export interface PayloadHeader {
    format: string;
    arrays: Record<string, ArrayPlace>;
}

export type PageArray = Float32Array | Uint32Array | Float64Array | Int32Array | Uint8Array;

export interface Payload<Header> {
    header: Header;
    array: (name: string) => PageArray;
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

/** Throws an Error whose message can be shown. \param format that this page reads */
export async function readPayload<Header extends PayloadHeader>(format: string): Promise<Payload<Header>> {
    const element = document.getElementById('meshwind-data');
    if (!element) throw new Error('This page has no data: it is the empty template.');
    const bytes = await gunzip(bytesOfBase64((element.textContent ?? '').trim()));
    element.remove(); // the text is as large as all else together
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const length = view.getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(bytes.subarray(4, 4 + length))) as Header;
    if (header.format !== format) {
        throw new Error(`The data is of format "${header.format}"; this page reads "${format}".`);
    }
    const base = bytes.byteOffset + 4 + length;
    const array = (name: string): PageArray => {
        const place = header.arrays[name];
        if (!place) throw new Error(`The data has no array "${name}".`);
        const Type = kTypes[place.type];
        const start = base + place.offset;
        const size = place.count * place.width;
        return start % Type.BYTES_PER_ELEMENT === 0
            ? new Type(bytes.buffer as ArrayBuffer, start, size)
            : new Type(bytes.slice(start - bytes.byteOffset).buffer, 0, size);
    };
    return { header, array };
}
