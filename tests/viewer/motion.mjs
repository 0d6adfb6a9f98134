// The machine in the picture against the program's own table.
import assert from 'node:assert/strict';
import { open, seek, state } from './browser.mjs';
import { arrayOf } from './payload.mjs';
import { axes, file, header, payload, programs, slide, someBlocks, test, variant } from './run.mjs';

test('slider turns the spindle as the program says', async (browser) => {
    const page = await open(browser, file);
    const chain = header.machine.mandrel_chain;
    const joint = chain.map((a) => a.type).lastIndexOf('rotary');
    const axis = chain[joint];
    const mount = header.machine.mount?.z ?? [0, 0, 1];
    const sign = Math.sign(axis.direction.reduce((sum, d, k) => sum + d * mount[k], 0));
    const off = (a, b) => Math.abs(((((a - b) % 360) + 540) % 360) - 180);
    for (const program of programs) {
        for (const block of someBlocks(program, 7).slice(1)) {
            for (const share of [1, 0.5]) {
                const [a, b] = [program.rows[block - 1], program.rows[block]];
                const time = a.time_s + share * (b.time_s - a.time_s);
                // The slider rounds; the end of a program, rounded up, is already in the next one.
                await slide(page, Math.min(program.start + time, program.end - 1e-6));
                const now = await state(page);
                const turn = sign * (a[axis.letter] + share * (b[axis.letter] - a[axis.letter]));
                // Times are rounded to 1 us in the table; the spindle turns some 1000 deg/s at most.
                assert.ok(Math.abs(now.spindle_deg - turn) < 0.01, `${now.spindle_deg}, not ${turn}`);
                if (chain.length === 1) {
                    assert.ok(off(now.drawn_turn_deg, turn) < 0.01, `drawn at ${now.drawn_turn_deg}`);
                }
            }
        }
    }
});

test('eye is where the table of the motion has it', async (browser) => {
    const page = await open(browser, file);
    let compared = 0;
    let worst = 0;
    for (const program of programs) {
        const blocks = someBlocks(program, 120);
        const eyes = await page.evaluate(
            (times) =>
                times.map((t) => {
                    window.meshwind.seek(t);
                    return window.meshwind.state().eye_mm;
                }),
            blocks.map((b) => program.start + program.time[b]),
        );
        blocks.forEach((b, i) => {
            // The start of a further program is the same moment as the end of the one before.
            if (b === 0 && program.start > 0) return;
            const row = program.rows[b];
            const [x, y, z] = eyes[i];
            worst = Math.max(worst, Math.hypot(x - row.ex_mm, y - row.ey_mm, z - row.ez_mm));
            ++compared;
        });
    }
    assert.ok(compared >= 100);
    assert.ok(worst < 1e-3, `off by ${worst} mm`);
});

test('any chain, a mount and meshes of the machine are followed', async (browser) => {
    const { mandrel_chain: own, eye_chain: others } = header.machine;
    const upright = (d) => Math.abs(d[2]) === 1;
    if (
        own.length !== 1 ||
        others[0].type !== 'linear' ||
        ![own[0], others[0]].every((a) => upright(a.direction)) ||
        header.machine.mount
    ) {
        return 'needs a spindle and a carriage along it';
    }
    // The carriage's axis moves the mandrel the other way instead; the spindle's line is at c, and
    // the mandrel is mounted a quarter turn on and away: eye' = M^-1 (c + eye - R(-turn) c).
    const c = [5, 3];
    const origin = [10, 20, 30];
    const path = variant('chain.html', (copy) => {
        const { machine } = copy.header;
        const carriage = machine.eye_chain.shift();
        carriage.direction = carriage.direction.map((d) => -d);
        machine.mandrel_chain.unshift(carriage);
        machine.mandrel_chain[1].point = [...c, 0];
        machine.mount = { origin, x: [0, 1, 0], z: [0, 0, 1] };
        machine.bodies.push({ type: 'mesh', link: null, points: 'mandrel/points', faces: 'mandrel/faces' });
        machine.bodies.push({
            type: 'capsule',
            link: own[0].letter,
            from: [0, 0, 0],
            to: [0, 0, 0],
            radius: 4,
        });
        const q = arrayOf(copy, `${programs[0].fibre.prefix}axes`);
        for (let i = 0; i < q.length; i += axes.length) [q[i], q[i + 1]] = [q[i + 1], q[i]];
    });
    const page = await open(browser, path);
    for (const block of someBlocks(programs[0], 40)) {
        await seek(page, programs[0].time[block]);
        const { eye_mm: eye } = await state(page);
        const row = programs[0].rows[block];
        const turn = (-row[own[0].letter] * own[0].direction[2] * Math.PI) / 180;
        const back = [
            c[0] * Math.cos(turn) - c[1] * Math.sin(turn),
            c[0] * Math.sin(turn) + c[1] * Math.cos(turn),
        ];
        const p = [c[0] + row.ex_mm - back[0] - origin[0], c[1] + row.ey_mm - back[1] - origin[1]];
        const expected = [p[1], -p[0], row.ez_mm - origin[2]];
        const off = Math.hypot(...expected.map((e, k) => e - eye[k]));
        assert.ok(off < 1e-3, `block ${block}: ${eye}, not ${expected}`);
    }
    assert.deepEqual(page.complaints, []);
    return undefined;
});

test('the fibre lands where the payload has it at the end of blocks', async (browser) => {
    const page = await open(browser, file);
    const program = programs[0];
    const stations = arrayOf(payload, `${program.fibre.prefix}station`);
    const positions = arrayOf(payload, `${program.fibre.prefix}position_mm`);
    const at = (station) => {
        const i = Math.min(Math.floor(station), positions.length / 3 - 2);
        return [0, 1, 2].map((k) => {
            const a = positions[3 * i + k];
            return a + (station - i) * (positions[3 * i + 3 + k] - a);
        });
    };
    const off = [];
    for (const block of someBlocks(program, 60)) {
        if (stations[block] < 0) continue;
        await seek(page, program.time[block]);
        const landed = at((await state(page)).station);
        off.push(Math.hypot(...at(stations[block]).map((x, k) => x - landed[k])));
    }
    off.sort((a, b) => a - b);
    // The drawn place is where the eye is in the tangent plane; a band's width apart is in sight.
    const width = header.tow.width_mm;
    assert.ok(
        off[Math.floor(0.9 * off.length)] < width,
        `nine in ten within ${off[Math.floor(0.9 * off.length)]} mm`,
    );
});
