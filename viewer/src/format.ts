/** Numbers as people read them: few digits, a thin space before the unit, a true minus. */

const kThin = '\u202f';
/** Below this numbers are told by their size only. */
const kTiny = 0.0001;

export function number(value: number | null | undefined, digits = 3): string {
    if (value === null || value === undefined || !Number.isFinite(value)) return '\u2013';
    const size = Math.abs(value);
    if (size > 0 && size < kTiny) return `<${kTiny}`;
    const decimals =
        size >= 1e4 || Number.isInteger(value)
            ? 0
            : Math.max(0, digits - 1 - Math.floor(Math.log10(Math.max(size, 10 ** (1 - digits)))));
    return grouped(value.toFixed(Math.min(decimals, 6)));
}

export function fixed(value: number, decimals: number): string {
    return Number.isFinite(value) ? grouped(value.toFixed(decimals)) : '\u2013';
}

function grouped(text: string): string {
    const [whole, fraction] = text.replace('-', '').split('.');
    const spaced = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, kThin) : whole;
    const digits = fraction === undefined ? spaced : `${spaced}.${fraction}`;
    return text.startsWith('-') && /[1-9]/.test(text) ? `\u2212${digits}` : digits;
}

export function withUnit(value: number | null | undefined, unit: string, digits = 3): string {
    const text = number(value, digits);
    return unit && text !== '\u2013' ? `${text}${unit === '°' ? '' : kThin}${unit}` : text;
}

export function percent(share: number): string {
    const value = share * 100;
    if (value > 0 && value < 0.05) return `<0.1${kThin}%`;
    const text = value > 99 && value < 100 ? value.toFixed(2) : value.toFixed(1);
    return `${text.replace(/\.0+$/, '')}${kThin}%`;
}

/** 95.3 as "1:35.3", 7384 as "2:03:04". */
export function clock(seconds: number): string {
    const tenths = Math.round(seconds * 10);
    const h = Math.floor(tenths / 36000);
    const m = Math.floor(tenths / 600) % 60;
    const s = Math.floor(tenths / 10) % 60;
    const two = (n: number) => String(n).padStart(2, '0');
    return h ? `${h}:${two(m)}:${two(s)}` : `${m}:${two(s)}.${tenths % 10}`;
}

const kUnits: [RegExp, string][] = [
    [/_mm_s2$/, 'mm/s²'],
    [/_mm_s$/, 'mm/s'],
    [/_per_mm$/, '1/mm'],
    [/_mm2$/, 'mm²'],
    [/_mm$/, 'mm'],
    [/_deg$/, '°'],
    [/_s$/, 's'],
    [/_g$/, 'g'],
    [/_per_m$/, '/m'],
    [/_m$/, 'm'],
    [/_ratio$/, '×'],
    [/fraction$/, '%'],
];

/** The unit that a key of the report ends in, and the key in words without it. */
export function keyInWords(key: string): { words: string; unit: string } {
    const hit = kUnits.find(([pattern]) => pattern.test(key));
    const unit = hit ? hit[1] : '';
    const bare = hit && unit !== '%' && unit !== '×' ? key.replace(hit[0], '') : key;
    return { words: sentence(bare.replace(/_/g, ' ')), unit };
}

export function valueInWords(value: number, unit: string): string {
    return unit === '%' ? percent(value) : withUnit(value, unit);
}

export function sentence(text: string): string {
    return text.charAt(0).toUpperCase() + text.slice(1);
}

export function escapeHtml(text: string): string {
    return text.replace(
        /[&<>"']/g,
        (c) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;', '"': '&quot;', "'": '&#39;' })[c] as string,
    );
}
