// The data block of a page, read and written without the page's own code.
import { gunzipSync, gzipSync } from 'node:zlib';

const kBlock = /(<script id="meshwind-data"[^>]*>)([^<]*)(<\/script>)/;
const kTypes = {
    f32: Float32Array,
    f64: Float64Array,
    u32: Uint32Array,
    i32: Int32Array,
    u8: Uint8Array,
};

/** {header, rest}: the header as an object and the bytes of all arrays. */
export function readPayload(html) {
    const bytes = gunzipSync(Buffer.from(kBlock.exec(html)[2], 'base64'));
    const length = bytes.readUInt32LE(0);
    return {
        header: JSON.parse(bytes.subarray(4, 4 + length).toString('utf8')),
        rest: Buffer.from(bytes.subarray(4 + length)),
    };
}

/** A view of one array; writing to it changes `rest`. */
export function arrayOf({ header, rest }, name) {
    const { type, width, count, offset } = header.arrays[name];
    return new kTypes[type](rest.buffer, rest.byteOffset + offset, width * count);
}

/** The page with other data. */
export function withPayload(html, { header, rest }) {
    let text = Buffer.from(JSON.stringify(header), 'utf8');
    text = Buffer.concat([text, Buffer.alloc((8 - ((4 + text.length) % 8)) % 8, ' ')]);
    const length = Buffer.alloc(4);
    length.writeUInt32LE(text.length);
    const packed = gzipSync(Buffer.concat([length, text, rest])).toString('base64');
    return html.replace(kBlock, (_, open, __, close) => open + packed + close);
}

/** Rows of a CSV file as objects of numbers and words. */
export function readCsv(text) {
    const [head, ...lines] = text.trim().split('\n');
    const names = head.split(',');
    return lines.map((line) => {
        const cells = line.split(',');
        return Object.fromEntries(
            names.map((name, i) => [name, Number.isNaN(Number(cells[i])) ? cells[i] : Number(cells[i])]),
        );
    });
}
