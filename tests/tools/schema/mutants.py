"""Every small change of a JSON value: a key renamed, removed or added, a value of another kind or size in the place of each."""
import copy

OTHERS = [None, True, 7.25, -1e12, "text", [], {}, [None], {"unknown_key": 1}]


def places(value, path=()):
    """The path of every value inside, and the value."""
    yield path, value
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in items:
        yield from places(inner, (*path, key))


def at(value, path):
    for key in path:
        value = value[key]
    return value


def replaced(value, path, by):
    if not path:
        return copy.deepcopy(by)
    changed = copy.deepcopy(value)
    at(changed, path[:-1])[path[-1]] = copy.deepcopy(by)
    return changed


def mutants(value, others=OTHERS, inside=()):
    """(what was changed, the changed value); of the part of the value at the path `inside` only."""
    for path, part in list(places(at(value, inside), inside)):
        name = "/".join(map(str, path))
        if path != inside:
            for other in others:
                if type(other) is not type(part) or other != part:
                    yield f"{name} = {other!r}", replaced(value, path, other)
        if isinstance(part, dict):
            yield f"{name} + unknown_key", replaced(value, path, {**part, "unknown_key": 12345})
            for key in part:
                rest = {k: v for k, v in part.items() if k != key}
                yield f"{name} - {key}", replaced(value, path, rest)
                yield f"{name}: {key} renamed", replaced(value, path, {**rest, key + "_x": part[key]})
