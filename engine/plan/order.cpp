#include "engine/plan/order.h"
#include <fmt/format.h>
#include <algorithm>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/graph/strong_components.hpp>
#include <numeric>
#include "engine/plan/groups.h"

namespace loopwright {
namespace {

using Graph = boost::compressed_sparse_row_graph<boost::directedS>;
using Kind = Plan::Entry::Kind;

/// A vertex is the result of one call: a group of outputs of a block, or its decision. An edge means "needs".
struct Vertex {
  int block;
  int group;  // -1: the decision
};

class Order {
 public:
  Order(Plan& plan, bool solve_algebraic_loops, Problems& problems)
      : plan_(plan), solve_algebraic_loops_(solve_algebraic_loops), problems_(problems) {}

  void run() {
    add_vertices();
    find_restarted_states();
    add_edges();
    std::vector<int> component(vertices_.size());
    const int components = boost::strong_components(
        graph_, boost::make_iterator_property_map(component.begin(), get(boost::vertex_index, graph_)));
    // Tarjan's algorithm numbers a component after all components that it needs: the numbers give the order.
    const Groups members(size_t(components), [&](const auto& tell) {
      for (size_t v = 0; v < vertices_.size(); ++v) tell(size_t(component[v]), int(v));
    });
    rate_of_.resize(vertices_.size());
    plan_.order.reserve(size_t(components)), entry_of_vertex_.assign(vertices_.size(), -1);
    for (size_t c = 0; c < members.size(); ++c) {
      const auto group = members[c];
      if (group.size() == 1 && !needs_itself(group[0]))
        add_entry(group[0]);
      else
        add_ring({group.begin(), group.end()}, component);
    }
    collect_rates();
    mark_needed();
    look_between_samples();
  }

 private:
  const BlockInfo& info(int block) const { return plan_.blocks[size_t(block)].type->info; }
  uint64_t mask(const Vertex& v) const {
    if (v.group < 0) return info(v.block).decision_reads_inputs ? ~uint64_t(0) : 0;
    for (const PortInfo& output : info(v.block).outputs)
      if (output.group == v.group) return output.fed_by;
    return 0;
  }

  void add_vertices() {
    vertex_of_number_.assign(size_t(plan_.signals), -1);
    first_vertex_.resize(plan_.blocks.size());
    decision_.assign(plan_.blocks.size(), -1);
    for (size_t b = 0; b < plan_.blocks.size(); ++b) {
      const Plan::Block& block = plan_.blocks[b];
      first_vertex_[b] = int(vertices_.size());
      for (int g = 0; g < info(int(b)).groups; ++g) vertices_.push_back({int(b), g});
      for (size_t o = 0; o < block.outputs.size(); ++o)
        if (const int group = info(int(b)).outputs[o].group; group >= 0)
          for (int i = 0;
               i < (info(int(b)).outputs[o].shape == PortInfo::Shape::vector ? block.output_lengths[o] : 1);
               ++i)
            vertex_of_number_[size_t(block.outputs[o] + i)] = first_vertex_[b] + group;
      if (block.type->kernels.decide) {
        decision_[b] = int(vertices_.size());
        vertices_.push_back({int(b), -1});
      }
    }
  }

  template <class F> void for_each_need(int v, F&& f) const {
    const Vertex& vertex = vertices_[size_t(v)];
    const auto& inputs = plan_.blocks[size_t(vertex.block)].inputs;
    const uint64_t fed = mask(vertex);
    for (size_t i = 0; i < inputs.size(); ++i)
      if (fed >> i & 1)
        for (Number n : inputs[i]) f(int(i), n);
    if (const int gate = plan_.blocks[size_t(vertex.block)].gate; gate >= 0)
      f(of_gate, plan_.gates[size_t(gate)].on);
  }
  static constexpr int of_gate = -1;  // in place of an input
  /// The vertex that computes a number; -1: it is a state, or a constant. A state that may start anew comes
  /// from its gate.
  int vertex_of(Number n) const {
    if (n < plan_.signals) return vertex_of_number_[size_t(n)];
    return restarted_states_.empty() ? -1 : restarted_states_[size_t(n - plan_.signals)];
  }
  void find_restarted_states() {
    for (const Plan::Gate& gate : plan_.gates) {
      for (const int b : gate.restarts) {
        const Plan::Block& block = plan_.blocks[size_t(b)];
        if (block.states == 0) continue;
        restarted_states_.resize(size_t(plan_.states), -1);
        std::fill_n(restarted_states_.begin() + block.first_state, block.states,
                    vertex_of_number_[size_t(gate.on)]);
      }
    }
  }
  void add_edges() {
    std::vector<std::pair<size_t, size_t>> edges;  // sorted by the vertex that needs the other
    edges.reserve(vertices_.size() * 2);
    for (size_t v = 0; v < vertices_.size(); ++v) {
      for_each_need(int(v), [&](int, Number n) {
        if (const int source = vertex_of(n); source >= 0) edges.emplace_back(v, size_t(source));
      });
      if (reads_decision(int(v))) edges.emplace_back(v, size_t(decision_[size_t(vertices_[v].block)]));
    }
    graph_ = Graph(boost::edges_are_sorted, edges.begin(), edges.end(), vertices_.size());
  }
  /// Outputs read the mode that is decided at the same instant, also those that read no input. Accepted
  /// memory is the exception, unless its outputs read the mode: they may close a loop.
  bool reads_decision(int v) const {
    const Vertex& vertex = vertices_[size_t(v)];
    if (vertex.group < 0 || decision_[size_t(vertex.block)] < 0) return false;
    return mask(vertex) != 0 || info(vertex.block).inputs.empty() || info(vertex.block).outputs_read_mode ||
           !plan_.blocks[size_t(vertex.block)].type->kernels.accept;
  }
  bool needs_itself(int v) const {
    const auto [begin, end] = boost::out_edges(size_t(v), graph_);
    return std::any_of(begin, end, [&](auto e) { return int(boost::target(e, graph_)) == v; });
  }

  static Rate join(const Rate& a, const Rate& b) {
    if (a.kind == Rate::Kind::constant) return b;
    if (b.kind == Rate::Kind::constant) return a;
    if (a.kind == Rate::Kind::continuous || b.kind == Rate::Kind::continuous)
      return {Rate::Kind::continuous, 0, 0};
    const int64_t period = std::gcd(std::gcd(a.period, b.period), std::abs(a.offset - b.offset));
    return {Rate::Kind::sampled, period, std::min(a.offset, b.offset) % period};
  }
  Rate rate_of_number(Number n) const {
    const int source = vertex_of_number_[size_t(n)];
    return source < 0 ? Rate{} : rate_of_[size_t(source)];
  }
  /// What is triggered runs at the samples of its trigger. A trigger is sampled with its own signal.
  std::optional<Rate> rate_by_trigger(int v) const {
    const Vertex& vertex = vertices_[size_t(v)];
    const Plan::Block& block = plan_.blocks[size_t(vertex.block)];
    if (block.gate >= 0 && plan_.gates[size_t(block.gate)].is_triggered)
      return rate_of_number(plan_.gates[size_t(block.gate)].on);
    const auto gate = std::ranges::find(plan_.gates, vertex.block, &Plan::Gate::block);
    if (gate == plan_.gates.end() || !gate->is_edge || block.inputs[0].empty()) return {};
    if (vertex.group >= 0) return rate_of_[size_t(decision_[size_t(vertex.block)])];
    const Number trigger = block.inputs[0][0];
    return trigger < plan_.signals ? rate_of_number(trigger) : Rate{Rate::Kind::continuous, 0, 0};
  }
  /// An Enable block asks for the time only to tell one instant from the next.
  bool depends_on_time(int block) const { return info(block).uses_time && info(block).type != "Enable"; }
  Rate own_rate(int v) const {
    const Vertex& vertex = vertices_[size_t(v)];
    const Plan::Block& block = plan_.blocks[size_t(vertex.block)];
    if (block.period > 0) return {Rate::Kind::sampled, block.period, block.offset};
    if (const auto rate = rate_by_trigger(v)) return *rate;
    if (depends_on_time(vertex.block) || info(vertex.block).is_continuous)
      return {Rate::Kind::continuous, 0, 0};
    Rate rate;
    for_each_need(v, [&](int, Number n) {
      if (n >= plan_.signals)
        rate = join(rate, {Rate::Kind::continuous, 0, 0});
      else if (vertex_of_number_[size_t(n)] >= 0)
        rate = join(rate, rate_of_[size_t(vertex_of_number_[size_t(n)])]);
    });
    if (reads_decision(v)) rate = join(rate, rate_of_[size_t(decision_[size_t(vertex.block)])]);
    return rate;
  }
  Plan::Entry entry_of(int v) {
    const Vertex& vertex = vertices_[size_t(v)];
    return {vertex.group < 0 ? Kind::decide : Kind::outputs, vertex.block, std::max(vertex.group, 0),
            rate_of_[size_t(v)]};
  }
  void add_entry(int v) {
    rate_of_[size_t(v)] = own_rate(v);
    entry_of_vertex_[size_t(v)] = int(plan_.order.size());
    plan_.order.push_back(entry_of(v));
  }

  void add_ring(const std::vector<int>& members, const std::vector<int>& component) {
    const std::string text = ring_text(members, component);
    if (!solve_algebraic_loops_) return tell_algebraic_loop(members, text, "");
    for (int v : members)
      if (plan_.blocks[size_t(vertices_[size_t(v)].block)].gate >= 0)
        return tell_algebraic_loop(members, text,
                                   "It holds a block of a subdiagram that does not always run; such an "
                                   "algebraic loop cannot be solved.");
    for (int v : members)
      if (vertices_[size_t(v)].group < 0)
        return tell_algebraic_loop(
            members, text, "It holds a block that switches; such an algebraic loop cannot be solved.");
    Plan::AlgebraicLoop loop;
    loop.text = text;
    // Tears: outputs are removed one by one, the most needed first, until no cycle remains.
    std::vector<int> left = members;
    std::vector<int> sorted;
    std::vector<bool> torn(vertices_.size(), false);
    while (!sort_acyclic(members, component, torn, sorted)) {
      const int v = *std::ranges::max_element(
          left, {}, [&](int m) { return torn[size_t(m)] ? -1 : wanted_inside(m, component); });
      torn[size_t(v)] = true;
    }
    Rate rate;
    for (int pass = 0; pass < 2; ++pass)
      for (int v : members) rate_of_[size_t(v)] = rate = join(rate, own_rate(v));
    for (int v : members) rate_of_[size_t(v)] = rate;
    for (int v : sorted) loop.entries.push_back(entry_of(v));
    for (Number n = 0; n < plan_.signals; ++n)
      if (const int v = vertex_of_number_[size_t(n)]; v >= 0 && torn[size_t(v)]) loop.tears.push_back(n);
    for (int v : members) entry_of_vertex_[size_t(v)] = int(plan_.order.size());
    plan_.order.push_back({Kind::algebraic_loop, int(plan_.algebraic_loops.size()), 0, rate});
    plan_.algebraic_loops.push_back(std::move(loop));
  }
  int wanted_inside(int v, const std::vector<int>& component) const {
    int n = 0;
    for (auto [e, end] = boost::out_edges(size_t(v), graph_); e != end; ++e)
      n += component[boost::target(*e, graph_)] == component[size_t(v)];
    return n;
  }
  /// Members in order, ignoring edges to torn vertices; false if a cycle remains.
  bool sort_acyclic(const std::vector<int>& members, const std::vector<int>& component,
                    const std::vector<bool>& torn, std::vector<int>& sorted) const {
    sorted.clear();
    std::vector<int> open(members);
    std::vector<bool> done(vertices_.size(), false);
    while (!open.empty()) {
      const size_t before = sorted.size();
      std::erase_if(open, [&](int v) {
        for (auto [e, end] = boost::out_edges(size_t(v), graph_); e != end; ++e) {
          const size_t target = boost::target(*e, graph_);
          if (component[target] == component[size_t(v)] && !torn[target] && !done[target]) return false;
        }
        done[size_t(v)] = true;
        sorted.push_back(v);
        return true;
      });
      if (sorted.size() == before) return false;
    }
    return true;
  }

  /// One closed path through the component, port by port.
  std::string ring_text(const std::vector<int>& members, const std::vector<int>& component) const {
    std::vector<std::string> steps;
    std::vector<int> seen_at(vertices_.size(), -1);
    int at = members[0];
    while (seen_at[size_t(at)] < 0) {
      seen_at[size_t(at)] = int(steps.size());
      int next = -1;
      std::string step;
      for_each_need(at, [&](int i, Number n) {
        const int source = vertex_of(n);
        if (next >= 0 || source < 0 || component[size_t(source)] != component[size_t(at)]) return;
        next = source;
        const Plan::Block& block = plan_.blocks[size_t(vertices_[size_t(at)].block)];
        step = i == of_gate ? fmt::format("{} -> {}, which it enables", plan_.name_of(n), block.path)
                            : fmt::format("{} -> {}.{}", plan_.name_of(n), block.path,
                                          block.type->info.inputs[size_t(i)].name);
      });
      if (next < 0) {  // an output group that needs its block's decision
        next = decision_[size_t(vertices_[size_t(at)].block)];
        steps.emplace_back();
      } else {
        steps.push_back(std::move(step));
      }
      at = next;
    }
    std::string text;
    for (size_t i = steps.size(); i-- > size_t(seen_at[size_t(at)]);)
      if (!steps[i].empty()) text += "\n    " + steps[i];
    return text;
  }

  void tell_algebraic_loop(const std::vector<int>& members, const std::string& text, std::string_view why) {
    const Plan::Block& block = plan_.blocks[size_t(vertices_[size_t(members[0])].block)];
    std::string breakers;
    auto& p = problems_.error(
        block.place, "", block.path,
        fmt::format("algebraic loop: each of these needs the next in the same instant{}", text));
    p.expected = "a state or a delay somewhere in the loop";
    p.hint = fmt::format(
        "a UnitDelay (sampled) or a LowPass (continuous) at one of these wires breaks it; "
        "\"algebraic_loops\": \"solve\" in \"solver\" solves it by Newton's method. {}",
        why);
    while (!p.hint.empty() && p.hint.back() == ' ') p.hint.pop_back();
  }

  void collect_rates() {
    const auto add = [&](const Rate& rate) {
      if (rate.kind == Rate::Kind::sampled && std::ranges::find(plan_.rates, rate) == plan_.rates.end())
        plan_.rates.push_back(rate);
    };
    for (const Plan::Entry& entry : plan_.order) add(entry.rate);
    for (const Plan::Block& block : plan_.blocks)
      if (block.period > 0) add({Rate::Kind::sampled, block.period, block.offset});
    std::ranges::sort(plan_.rates, {}, [](const Rate& r) { return std::pair(r.period, r.offset); });
    for (const Rate& rate : plan_.rates)
      if (plan_.rates.size() > 60) {
        problems_.error(
            {}, "/solver", "",
            fmt::format(
                "{} different sample rates; at most 60 can be handled, this one repeats every {} ticks",
                plan_.rates.size(), rate.period));
        return;
      }
  }

  /// Propagates backwards from derivatives, crossings, decisions, jumps and accepted memory.
  void mark_needed() {
    std::vector<bool> for_stages(vertices_.size(), false), for_events(vertices_.size(), false);
    for (size_t b = 0; b < plan_.blocks.size(); ++b) {
      const Kernels<double>& k = plan_.blocks[b].type->kernels;
      if (k.derivatives) need_inputs(int(b), for_stages);
      if (plan_.blocks[b].period == 0 && (k.crossings || k.decide || k.jump || k.accept))
        need_inputs(int(b), for_events);
      if (decision_[b] >= 0 && plan_.blocks[b].period == 0) for_events[size_t(decision_[b])] = true;
    }
    // What is switched off keeps the signals of that instant, whether or not a row is recorded there.
    for (size_t v = 0; v < vertices_.size(); ++v)
      if (plan_.blocks[size_t(vertices_[v].block)].gate >= 0)
        for_events[v] = true, need_inputs(vertices_[v].block, for_events);
    // A loop is solved starting from its last solution: the number of solutions must not depend on the
    // recording.
    for (size_t v = 0; v < vertices_.size(); ++v)
      if (is_in_algebraic_loop(v)) for_events[v] = true, need_inputs(vertices_[v].block, for_events);
    for (size_t v = 0; v < vertices_.size(); ++v) {
      if (entry_of_vertex_[v] < 0) continue;
      Plan::Entry& entry = plan_.order[size_t(entry_of_vertex_[v])];
      if (entry.rate.kind != Rate::Kind::continuous) continue;
      entry.in_stages |= for_stages[v], entry.for_events |= for_events[v];
    }
  }
  bool is_in_algebraic_loop(size_t v) const {
    return entry_of_vertex_[v] >= 0 && plan_.order[size_t(entry_of_vertex_[v])].kind == Kind::algebraic_loop;
  }
  void look_between_samples() {
    bool& steps = plan_.steps_between_samples = plan_.states > 0;
    for (const Plan::Entry& entry : plan_.order)
      steps |= entry.rate.kind == Rate::Kind::continuous && entry.kind != Kind::outputs;
    for (const Plan::Block& block : plan_.blocks) steps |= block.type->kernels.accept != nullptr;
  }
  void need_inputs(int block, std::vector<bool>& needed) {
    std::vector<int> todo;
    const auto want = [&](Number n) {
      const int v = vertex_of(n);
      if (v >= 0 && !needed[size_t(v)]) needed[size_t(v)] = true, todo.push_back(v);
    };
    for (const auto& port : plan_.blocks[size_t(block)].inputs)
      for (Number n : port) want(n);
    if (const int gate = plan_.blocks[size_t(block)].gate; gate >= 0) want(plan_.gates[size_t(gate)].on);
    while (!todo.empty()) {
      const int v = todo.back();
      todo.pop_back();
      for_each_need(v, [&](int, Number n) { want(n); });
    }
  }

  Plan& plan_;
  const bool solve_algebraic_loops_;
  Problems& problems_;
  Graph graph_;
  std::vector<Vertex> vertices_;
  std::vector<int> first_vertex_, decision_, vertex_of_number_;
  std::vector<int> restarted_states_;  // the vertex of the gate of each state, or -1; empty: there are none
  std::vector<Rate> rate_of_;
  std::vector<int> entry_of_vertex_;  // -1: part of an algebraic loop that is an error
};

}  // namespace

void find_order(Plan& plan, bool solve_algebraic_loops, Problems& problems) {
  Order(plan, solve_algebraic_loops, problems).run();
}

}  // namespace loopwright
