"""The picture of --png: a PNG of the size asked for, whatever the threads; wall and bands differ."""
import struct
import zlib

import program

HOOPS = '{"tow": {"width": 12}, "layers": [{"kind": "hoop"}], "mandrel": {"extension": 40}}'


def paeth(a, b, c):
    p = a + b - c
    pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
    return a if pa <= pb and pa <= pc else b if pb <= pc else c


def read_png(data):
    """Width, height, rows of (r, g, b, a); the PNG specification, second edition, 5 and 9."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    place, packed, kinds = 8, b"", []
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + length]
        assert struct.unpack(">I", data[place + 8 + length:place + 12 + length])[0] == \
            zlib.crc32(kind + body)
        kinds.append(kind)
        packed += body if kind == b"IDAT" else b""
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", body)
        place += 12 + length
    assert kinds[0] == b"IHDR" and kinds[-1] == b"IEND"
    width, height = header[:2]
    assert header[2:] == (8, 6, 0, 0, 0), header
    raw, rows, above = zlib.decompress(packed), [], bytes(4 * width)
    for y in range(height):
        start = y * (4 * width + 1)
        kind, line = raw[start], bytearray(raw[start + 1:start + 1 + 4 * width])
        for i in range(4 * width):
            a = line[i - 4] if i >= 4 else 0
            c = above[i - 4] if i >= 4 else 0
            line[i] = (line[i] + (0, a, above[i], (a + above[i]) // 2,
                                  paeth(a, above[i], c))[kind]) % 256
        rows.append([tuple(line[4 * x:4 * x + 4]) for x in range(width)])
        above = bytes(line)
    return width, height, rows


class Preview(program.ProgramTest):
    def picture(self, *arguments):
        if not (self.folder / "cylinder.stl").exists():
            self.make("cylinder", "--radius", "40", "--length", "160", "--edge", "10")
            self.write("hoops.json", HOOPS)
        file = self.folder / "view.png"
        self.done("cylinder.stl", "--job", "hoops.json", "--force", "--png", file,
                  "--png-size", "240x150", *arguments)
        return file.read_bytes()

    def test_picture_of_hoops(self):
        data = self.picture("--threads", "1")
        width, height, rows = read_png(data)
        self.assertEqual((width, height), (240, 150))
        pixels = [pixel for row in rows for pixel in row]
        self.assertEqual(pixels[0][3], 0)
        solid = [pixel for pixel in pixels if pixel[3] == 255]
        self.assertGreater(len(solid), len(pixels) // 8)
        # The hoops are one course, orange; what is bare is grey.
        orange = [p for p in solid if p[0] - p[2] > 80]
        grey = [p for p in solid if max(p[:3]) - min(p[:3]) < 30]
        self.assertGreater(len(orange), len(solid) // 3)
        self.assertGreater(len(grey), 100)
        self.assertEqual(data, self.picture("--threads", "2"))

    def test_colours_by_layers(self):
        _, _, rows = read_png(self.picture("--png-colour", "layers"))
        solid = [p for row in rows for p in row if p[3] == 255]
        self.assertFalse([p for p in solid if p[0] - p[2] > 80 and p[1] < p[0] - 40])

    def test_no_picture_unless_asked_for(self):
        self.picture()
        self.assertEqual({p.name for p in self.folder.iterdir()},
                         {"cylinder.stl", "hoops.json", "view.png", "meshwind-out"})
        self.assertFalse(list((self.folder / "meshwind-out").glob("*.png")))

    def test_refused_before_the_run(self):
        self.make("cylinder")
        for arguments in (("--png", "a.png", "--png-size", "big"), ("--png", "none/a.png"),
                          ("--png-size", "10x10"), ("--png", "a.png", "--png-colour", "red")):
            result = self.run_program("cylinder.stl", *arguments)
            self.assertEqual(result.returncode, 2, arguments)
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["cylinder.stl"])


if __name__ == "__main__":
    program.main("__main__")
