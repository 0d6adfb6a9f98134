"""A page of tables from a JSON Schema, of the vocabulary that the schemas of data/schema use. Anything else is an error."""
import json

from reference_pages import wrapped

MADE = "made by docs/make_reference.py; do not edit"
KNOWN = {"type", "description", "enum", "const", "default", "oneOf", "properties", "required", "additionalProperties",
         "items", "minItems", "maxItems", "minimum", "maximum", "exclusiveMinimum", "minLength", "pattern", "not",
         "allOf", "anyOf", "$ref", "$schema", "title", "definitions", "$defs"}


class _Page:
    def __init__(self, schema):
        self.schema = schema
        self.shapes = {}  # name of a definition: the object that it stands for, in order of use

    def resolve(self, node):
        """The node with what it refers to."""
        if unknown := set(node) - KNOWN:
            raise ValueError(f"the schema has {sorted(unknown)}, which reference_schema.py does not know")
        if "$ref" not in node:
            return node, ""
        folder, name = node["$ref"].removeprefix("#/").split("/")
        inner, deeper = self.resolve(self.schema[folder][name])
        return {**inner, **{k: v for k, v in node.items() if k != "$ref"}}, deeper or name

    def value(self, node):
        """What the key takes, in words."""
        node, name = self.resolve(node)
        if "enum" in node:
            return " ".join(f"`{json.dumps(v)}`" for v in node["enum"] if v is not None)
        if "const" in node:
            return f"`{json.dumps(node['const'])}`"
        if "oneOf" in node and "properties" not in node:
            return " or ".join(w for w in (self.choice(n) for n in node["oneOf"]) if w != "null")
        kinds = node["type"] if isinstance(node["type"], list) else [node["type"]]
        kind = next(k for k in kinds if k != "null") if kinds != ["null"] else "null"
        if kind == "object":
            if name and "properties" in node:
                self.shapes.setdefault(name, node)
                return f"[{name}](#{name.lower()})"
            return "object"
        if kind == "array":
            if node.get("minItems") == node.get("maxItems") is not None:
                return f"list of {node['minItems']} numbers"
            return f"list of {self.value(node['items'])}" + (", one at least" if node.get("minItems") else "")
        if kind in ("number", "integer"):
            return self.numbers(node, kind)
        if kind == "string" and "pattern" in node:
            return {"^[A-Z]$": "a capital letter", "^([A-Z]|base)$": "a capital letter or `\"base\"`",
                    "^[A-Z]{6}$": "six capital letters", "^[A-Z-]{1,6}$": "up to six capital letters or `-`"}.get(
                        node["pattern"], "text of one line")
        return {"string": "text", "boolean": "`true` `false`", "null": "null"}[kind]

    def choice(self, node):
        """One of several forms: a small object is shown where it stands."""
        text = self.value(node)
        if text == "object":
            return "{" + ", ".join(f"`{k}`: {self.value(n)}" for k, n in self.resolve(node)[0]["properties"].items()) + "}"
        return text

    @staticmethod
    def numbers(node, kind):
        word = "whole number" if kind == "integer" else "number"
        if "exclusiveMinimum" in node:
            low = f" > {node['exclusiveMinimum']}"
        else:
            low = f" >= {node['minimum']}" if "minimum" in node else ""
        high = f" <= {node['maximum']}" if node.get("maximum", 2 ** 31 - 1) not in (2 ** 31 - 1, 1000000) else ""
        out = " other than " + str(node["not"]["const"]) if "const" in node.get("not", {}) else ""
        return word + ",".join(p for p in (low, high, out) if p)

    def table(self, node, path):
        """Rows of an object and of the objects in it."""
        lines = ["| key | value | default | meaning |", "|---|---|---|---|"]
        inner = []
        for key, child in node["properties"].items():
            whole, name = self.resolve(child)
            text = self.value(child)
            rows = whole["type"] if "type" in whole else ""
            deep = None
            if ("object" in rows and "properties" in whole and text == "object"):
                deep = (f"{path}{key}", whole)
            elif rows == "array" and "properties" in self.resolve(whole.get("items", {}))[0] and text.startswith("list of object"):
                deep = (f"{path}{key}[]", whole["items"])
            if deep:
                inner.append(deep)
            default = f"`{json.dumps(whole['default'])}`" if "default" in whole and "const" not in whole else ""
            if key in node.get("required", ()):
                default = "required"
            lines.append(f"| `{path}{key}` | {text.replace('|', chr(92) + '|')} | {default} | "
                         f"{whole.get('description', '')} |")
        return lines, inner

    # ---- conditions

    @staticmethod
    def keys(names):
        return ", ".join(f"`{n}`" for n in names)

    def condition(self, node, path):
        """The if of a rule: "`kind` is `imported`", and its opposite."""
        if set(node) == {"not"}:
            yes, no = self.condition(node["not"], path)
            return no, yes
        (key, inner), = node["properties"].items()
        if "properties" in inner:
            return self.condition(inner, f"{path}{key}.")
        words = " or ".join(f"`{v}`" for v in ([inner["const"]] if "const" in inner else inner["enum"]))
        return f"Where `{path}{key}` is {words}", f"Where `{path}{key}` is not {words}"

    def demands(self, node, path):
        """What then or else asks for."""
        said = []
        if "required" in node:
            said.append(f"{self.keys(path + n for n in node['required'])} must be given")
        if "not" in node:
            banned = [r["required"][0] for r in node["not"].get("anyOf", [node["not"]])]
            said.append(f"there is no {self.keys(path + n for n in banned)}")
        for key, inner in node.get("properties", {}).items():
            if "const" in inner:
                said.append(f"`{path}{key}` is `{inner['const']}`")
            else:
                said.append(self.demands(inner, f"{path}{key}."))
        return " and ".join(said)

    def rules(self, node, path):
        out = []
        for rule in node.get("allOf", ()):
            yes, no = self.condition(rule["if"], path)
            for words, part in ((yes, "then"), (no, "else")):
                if part in rule:
                    out.append(f"- {words}, {self.demands(rule[part], path)}.")
        for way in [node["oneOf"]] if "oneOf" in node and "properties" in node else []:
            out.append("- Either " + ", or ".join(self.keys(path + n for n in w["required"]) for w in way) + ".")
        if "anyOf" in node and "properties" in node:
            out.append("- Either " + ", or ".join(self.keys(path + n for n in w["required"]) for w in node["anyOf"]) +
                       ".")
        return out


def schema_page(schema, name, title, more):
    """The page of one schema, Markdown. `name` is its file's."""
    page = _Page(schema)
    out = [f"<!-- {MADE} -->", f"# {title}", "",
           *wrapped(f"{schema['description']} {more} The schema is `data/schema/{name}`.")]
    waiting = [("", schema)]
    while waiting:
        name, node = waiting.pop(0)
        prefix = f"{name}." if name else ""
        if name:
            out += ["", f"## {name.replace('[]', '')}"]
            if node.get("description"):
                out += ["", node["description"][0].upper() + node["description"][1:] + "."]
        lines, inner = page.table(node, prefix)
        out += [""] + lines
        if rules := page.rules(node, prefix):
            out += [""] + rules
        waiting = inner + waiting
    shown = set()
    while rest := [n for n in page.shapes if n not in shown]:
        shown.add(rest[0])
        lines, _ = page.table(page.shapes[rest[0]], "")
        out += ["", f"## {rest[0]}", ""] + lines
    return "\n".join(out) + "\n"
