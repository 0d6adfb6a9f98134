"""The data in report.html, read by the standard library alone."""
import array
import base64
import gzip
import json
import re
import struct

TYPES = {"f32": "f", "f64": "d", "u32": "I", "i32": "i", "u8": "B"}

# To whole multiples of what the page rounds fibre and eye.
SHOWN = {"position_mm": 2**-8, "normal": 2**-11, "tangent": 2**-11, "s_mm": 2**-6, "slip": 2**-11,
         "bridge_mm": 2**-8, "free_length_mm": 2**-6, "eye_mm": 2**-6}


class Page:
    """The block of data in a page, as report/page_data.h describes it."""

    def __init__(self, text):
        found = re.search(r'<script id="meshwind-data" type="application/octet-stream">'
                          r'([A-Za-z0-9+/=]*)</script>', text)
        data = gzip.decompress(base64.b64decode(found.group(1), validate=True))
        length, = struct.unpack_from("<I", data)
        self.header = json.loads(data[4:4 + length])
        self.rest = data[4 + length:]
        self.begin = 4 + length

    def __getitem__(self, name):
        """Rows of an array; numbers where a row has one entry."""
        table = self.header["arrays"][name]
        assert (self.begin + table["offset"]) % 8 == 0
        entries = array.array(TYPES[table["type"]])
        end = table["offset"] + entries.itemsize * table["count"] * table["width"]
        entries.frombytes(self.rest[table["offset"]:end])
        width = table["width"]
        if width == 1:
            return list(entries)
        return [entries[i:i + width] for i in range(0, len(entries), width)]

    def measures(self):
        """Of each check of the report that has any: its name, itself, and what it measures."""
        for name, check in self.header["report"]["checks"].items():
            kind = re.sub(r"(-layer-\d+)?(-\d+)?$", "", name)
            for measure in self.header["check_kinds"][kind]["measures"]:
                yield name, check, measure
