"""What in an OpenAPI document would break a client of the document before.

A client sends what it sent and reads what it read: a call, a parameter, a field or a role taken away, a type changed,
something that must now be sent, and something that may now be missing from an answer.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

Json = dict[str, Any]
_METHODS = ("get", "post", "put", "delete")


def breaks(before: Json, now: Json) -> Iterator[str]:
    """Each of them, as a line that says where."""
    comparison = _Comparison(before, now)
    for path, operations in before["paths"].items():
        for method in _METHODS:
            if method not in operations:
                continue
            where = f"{method.upper()} {path}"
            following = now["paths"].get(path, {}).get(method)
            if following is None:
                yield f"{where}: taken away"
            else:
                yield from comparison.operation(where, operations[method], following)


class _Comparison:
    """Two documents; pairs of schemas that were compared are not compared again, for they may hold each other."""

    def __init__(self, before: Json, now: Json) -> None:
        self.before, self.now = before, now
        self.seen: set[tuple[str, str, bool]] = set()

    def operation(self, where: str, before: Json, now: Json) -> Iterator[str]:
        if before.get("operationId") != now.get("operationId"):
            yield f"{where}: is called {now.get('operationId')}, was {before.get('operationId')}"
        for role in sorted(_roles(before) - _roles(now)) if _roles(now) else ():
            yield f"{where}: role {role} taken away"
        if not _roles(before) and _roles(now):
            yield f"{where}: was open to anyone"
        yield from self._parameters(where, before, now)
        yield from self._body(where, before.get("requestBody"), now.get("requestBody"))
        yield from self._answers(where, before["responses"], now["responses"])

    def _parameters(self, where: str, before: Json, now: Json) -> Iterator[str]:
        old, new = ({(each["in"], each["name"]): each for each in of.get("parameters", ())} for of in (before, now))
        for key, parameter in old.items():
            at = f"{where}, parameter {key[1]}"
            if key not in new:
                yield f"{at}: taken away"
                continue
            if new[key].get("required") and not parameter.get("required"):
                yield f"{at}: must now be sent"
            yield from self._schema(at, parameter["schema"], new[key]["schema"], sent=True)
        for key in new.keys() - old.keys():
            if new[key].get("required"):
                yield f"{where}, parameter {key[1]}: must now be sent"

    def _body(self, where: str, before: Json | None, now: Json | None) -> Iterator[str]:
        if before is None:
            if now is not None and now.get("required"):
                yield f"{where}, body: must now be sent"
            return
        if now is None:
            yield f"{where}, body: taken away"
            return
        if now.get("required") and not before.get("required"):
            yield f"{where}, body: must now be sent"
        yield from self._contents(f"{where}, body", before["content"], now["content"], sent=True)

    def _answers(self, where: str, before: Json, now: Json) -> Iterator[str]:
        for status, answer in before.items():
            if status not in now:
                yield f"{where}, answer {status}: taken away"
            else:
                contents = answer.get("content", {}), now[status].get("content", {})
                yield from self._contents(f"{where}, answer {status}", *contents, sent=False)

    def _contents(self, where: str, before: Json, now: Json, sent: bool) -> Iterator[str]:
        for kind, content in before.items():
            if kind not in now:
                yield f"{where}: {kind} taken away"
            else:
                yield from self._schema(where, content.get("schema", {}), now[kind].get("schema", {}), sent)

    def _schema(self, where: str, before: Json, now: Json, sent: bool) -> Iterator[str]:
        pair = (before.get("$ref", ""), now.get("$ref", ""), sent)
        if pair[0] and pair[1]:
            if pair in self.seen:
                return
            self.seen.add(pair)
        old, new = _resolved(self.before, before), _resolved(self.now, now)
        if "properties" in old and "properties" in new:
            yield from self._fields(where, old, new, sent)
            return
        for word in ("items", "additionalProperties"):
            if isinstance(old.get(word), dict) and isinstance(new.get(word), dict):
                yield from self._schema(f"{where}[]", old[word], new[word], sent)
        yield from self._kinds(where, old, new, sent)

    def _fields(self, where: str, old: Json, new: Json, sent: bool) -> Iterator[str]:
        for name, schema in old["properties"].items():
            at = f"{where}.{name}"
            if name not in new["properties"]:
                yield f"{at}: taken away"
            else:
                yield from self._schema(at, schema, new["properties"][name], sent)
        must, did = set(new.get("required", ())), set(old.get("required", ()))
        if sent:
            yield from (f"{where}.{name}: must now be sent" for name in sorted(must - did))
        else:
            yield from (
                f"{where}.{name}: may now be missing" for name in sorted((did - must) & new["properties"].keys())
            )

    def _kinds(self, where: str, old: Json, new: Json, sent: bool) -> Iterator[str]:
        """Of what is sent each kind must still be taken, of an answer none may be new: of both where either is none."""
        before, now = _kinds(old), _kinds(new)
        wrong = before - now if sent else now - before
        if before and now and wrong:
            yield f"{where}: {' or '.join(sorted(before))} is now {' or '.join(sorted(now))}"
            return
        alternatives = new.get("anyOf", [new])
        for one in old.get("anyOf", [old]):
            match = [each for each in alternatives if _kinds(each) == _kinds(one)]
            if "anyOf" in old and len(match) == 1:
                yield from self._schema(where, one, match[0], sent)


def _resolved(document: Json, schema: Json) -> Json:
    while "$ref" in schema:
        schema = document["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    return schema


def _kinds(schema: Json) -> set[str]:
    """What a value may be: types, names of components, words of a choice."""
    if "anyOf" in schema:
        return set().union(*map(_kinds, schema["anyOf"]))
    if "$ref" in schema:
        return {schema["$ref"].rpartition("/")[2]}
    if "enum" in schema or "const" in schema:
        return {repr(word) for word in schema.get("enum", [schema.get("const")])}
    found = schema.get("type", [])
    return {found} if isinstance(found, str) else set(found)


def _roles(operation: Json) -> set[str]:
    return {role for each in operation.get("security", ()) for role in each["token"]}
