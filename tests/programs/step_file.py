"""A strict reader of STEP files, ISO 10303-21, for the entities of a wireframe of polylines.

Anything else than the grammar of clear text encoding is refused, so are names given twice, references to what is
not there, entities of another kind than the attribute asks for, and a wrong number of attributes.
"""
import re

TOKEN = re.compile(r"""\s*(?:(?P<text>'(?:[^'\\]|''|\\\\)*')|(?P<name>\#[0-9]+)|(?P<enum>\.[A-Z_][A-Z0-9_]*\.)
                           |(?P<real>[+-]?[0-9]+\.[0-9]*(?:E[+-]?[0-9]+)?)|(?P<int>[+-]?[0-9]+)
                           |(?P<word>[A-Z][A-Z0-9_]*(?:-[A-Z0-9-]+)*)|(?P<sign>[()=;,$*]))""", re.VERBOSE)
# Attributes in the order of the schema (AP214): T text, R real, I integer, a name of what is referred to, [] a list.
SCHEMA = {
    "APPLICATION_CONTEXT": ["T"],
    "APPLICATION_PROTOCOL_DEFINITION": ["T", "T", "I", "APPLICATION_CONTEXT"],
    "PRODUCT_CONTEXT": ["T", "APPLICATION_CONTEXT", "T"],
    "PRODUCT": ["T", "T", "T", ["PRODUCT_CONTEXT"]],
    "PRODUCT_RELATED_PRODUCT_CATEGORY": ["T", "$", ["PRODUCT"]],
    "PRODUCT_DEFINITION_FORMATION": ["T", "T", "PRODUCT"],
    "PRODUCT_DEFINITION_CONTEXT": ["T", "APPLICATION_CONTEXT", "T"],
    "PRODUCT_DEFINITION": ["T", "T", "PRODUCT_DEFINITION_FORMATION", "PRODUCT_DEFINITION_CONTEXT"],
    "PRODUCT_DEFINITION_SHAPE": ["T", "T", "PRODUCT_DEFINITION"],
    "SHAPE_DEFINITION_REPRESENTATION": ["PRODUCT_DEFINITION_SHAPE",
                                        "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION"],
    "GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION":
        ["T", ["AXIS2_PLACEMENT3D", "GEOMETRIC_CURVE_SET"], "GEOMETRIC_REPRESENTATION_CONTEXT"],
    "GEOMETRIC_CURVE_SET": ["T", ["POLYLINE"]],
    "POLYLINE": ["T", ["CARTESIAN_POINT"]],
    "CARTESIAN_POINT": ["T", ["R"]],
    "DIRECTION": ["T", ["R"]],
    "AXIS2_PLACEMENT3D": ["T", "CARTESIAN_POINT", "DIRECTION", "DIRECTION"],
    "UNCERTAINTY_MEASURE_WITH_UNIT": ["LENGTH_MEASURE", "LENGTH_UNIT", "T", "T"],
}


class StepError(Exception):
    pass


def need(condition, message):
    if not condition:
        raise StepError(message)


class StepFile:
    def __init__(self, text):
        self.tokens = self.split(text)
        self.at = 0
        self.entity = {}
        self.read()
        for name, parts in self.entity.items():
            for kind, attributes in parts.items():
                if len(parts) == 1:
                    need(kind in SCHEMA, f"{name}: {kind} is not of a wireframe")
                    need(len(attributes) == len(SCHEMA[kind]), f"{name}: attributes of {kind}")
                    for wanted, found in zip(SCHEMA[kind], attributes):
                        self.check(wanted, found, name)

    @staticmethod
    def split(text):
        tokens, at = [], 0
        text = text.rstrip()
        while at < len(text):
            match = TOKEN.match(text, at)
            need(match, f"no token at {text[at:at + 30]!r}")
            tokens.append((match.lastgroup, match[match.lastgroup]))
            at = match.end()
        return tokens

    def take(self, *wanted):
        need(self.at < len(self.tokens), "the file ends too early")
        token = self.tokens[self.at]
        need(not wanted or token[1] in wanted or token[0] in wanted, f"{token} where {wanted} is due")
        self.at += 1
        return token

    def next_is(self, text):
        return self.tokens[self.at][1] == text

    def value(self):
        kind, text = self.take()
        if text == "(":
            values = []
            while not self.next_is(")"):
                values.append(self.value())
                if not self.next_is(")"):
                    self.take(",")
                    need(not self.next_is(")"), "a comma before a bracket")
            self.take(")")
            return values
        if kind == "word":
            self.take("(")
            self.at -= 1
            return (text, self.value())
        need(kind in ("text", "name", "enum", "real", "int") or text in ("$", "*"), f"{text} is no value")
        if kind == "text":
            return text[1:-1].replace("''", "'").replace("\\\\", "\\")
        return {"real": float, "int": int}.get(kind, str)(text) if kind != "name" else ("#", text)

    def read(self):
        for word in ("ISO-10303-21", ";", "HEADER", ";"):
            self.take(word)
        self.header = {}
        for word in ("FILE_DESCRIPTION", "FILE_NAME", "FILE_SCHEMA"):
            self.take(word)
            self.header[word] = self.value()
            self.take(";")
        need([len(v) for v in self.header.values()] == [2, 7, 1], "head")
        for word in ("ENDSEC", ";", "DATA", ";"):
            self.take(word)
        while not self.next_is("ENDSEC"):
            name = self.take("name")[1]
            need(name not in self.entity, f"{name} twice")
            self.take("=")
            parts = {}
            if self.next_is("("):
                self.take("(")
                while not self.next_is(")"):
                    kind = self.take("word")[1]
                    parts[kind] = self.value()
                self.take(")")
                need(list(parts) == sorted(parts), f"{name}: parts by the alphabet")
            else:
                kind = self.take("word")[1]
                parts[kind] = self.value()
            self.entity[name] = parts
            self.take(";")
        for word in ("ENDSEC", ";", "END-ISO-10303-21", ";"):
            self.take(word)
        need(self.at == len(self.tokens), "more after the end")

    def check(self, wanted, found, where):
        if isinstance(wanted, list):
            need(isinstance(found, list) and found, f"{where}: a list")
            for one in found:
                need(any(self.fits(kind, one) for kind in wanted), f"{where}: {one} in a list")
        else:
            need(self.fits(wanted, found), f"{where}: {found} where {wanted} is due")

    def fits(self, wanted, found):
        if wanted in ("T", "R", "I"):
            return isinstance(found, {"T": str, "R": float, "I": int}[wanted])
        if wanted == "$":
            return found == "$"
        if isinstance(found, tuple) and found[0] == "#":
            return found[1] in self.entity and wanted in self.entity[found[1]]
        return isinstance(found, tuple) and found[0] == wanted

    def of(self, kind):
        return [parts[kind] for parts in self.entity.values() if kind in parts]

    def polylines(self):
        """Points of each polyline under its name, by way of the product's shape."""
        (shape,) = self.of("SHAPE_DEFINITION_REPRESENTATION")
        _, items, context = self.entity[shape[1][1]]["GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION"]
        units = self.entity[context[1]]["GLOBAL_UNIT_ASSIGNED_CONTEXT"][0]
        need(any(self.entity[unit[1]].get("SI_UNIT") == [".MILLI.", ".METRE."] for unit in units), "mm")
        lines = {}
        for _, item in items:
            if "GEOMETRIC_CURVE_SET" in self.entity[item]:
                name, curves = self.entity[item]["GEOMETRIC_CURVE_SET"]
                need(len(curves) == 1 and name not in lines, name)
                of_curve, points = self.entity[curves[0][1]]["POLYLINE"]
                need(of_curve == name, "names of set and polyline")
                lines[name] = [self.entity[p]["CARTESIAN_POINT"][1] for _, p in points]
                need(all(len(p) == 3 for p in lines[name]) and len(lines[name]) > 1, name)
        return lines
