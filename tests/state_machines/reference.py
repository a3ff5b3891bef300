"""A state machine as docs/state_machines.md describes it, in plain Python."""


class Machine:
    """`states` as in a diagram; `guard(state, transition, inputs, waited)` gives the truth of a guard."""

    def __init__(self, states, outputs, initial, guard):
        self.states, self.guard = states, guard
        self.number = {state["name"]: i for i, state in enumerate(states)}
        self.initial = initial
        self.values = {name: 0.0 for name in outputs}
        self.active = None
        self.samples = {}

    def outer(self, name):
        return self.states[self.number[name]].get("inside")

    def line(self, name):
        """The states that are active with this one, from the outermost to itself."""
        names = []
        while name:
            names.insert(0, name)
            name = self.outer(name)
        return names

    def default(self, outer, wanted):
        if wanted:
            return wanted
        inside = [state["name"] for state in self.states if state.get("inside") == outer]
        return inside[0] if inside else None

    def enter(self, name):
        self.samples[name] = 0
        self.values.update(self.states[self.number[name]].get("set", {}))
        self.active = name

    def enter_with_defaults(self, name):
        while name:
            self.enter(name)
            name = self.default(name, self.states[self.number[name]].get("initial"))

    def take(self, source, target):
        stays = [name for name in self.line(source)[:-1] if name in self.line(target)[:-1]]
        for name in self.line(target)[:-1]:
            if name not in stays:
                self.enter(name)
        self.enter_with_defaults(target)

    def sample(self, inputs):
        """The number of the active state and the outputs."""
        if self.active is None:
            self.enter_with_defaults(self.default(None, self.initial))
        else:
            for name in self.line(self.active):
                self.samples[name] += 1
            self.take_first(inputs)
        return [float(self.number[self.active])] + list(self.values.values())

    def take_first(self, inputs):
        for name in self.line(self.active):
            transitions = self.states[self.number[name]].get("transitions", [])
            for i, transition in sorted(enumerate(transitions), key=lambda pair: pair[1].get("priority", 0)):
                if self.guard(name, i, inputs, self.samples[name]):
                    return self.take(name, transition["to"])
