/// The blocks in a diagram's file.
#pragma once
#include "engine/json/tokens.h"
#include "engine/json/value.h"

namespace loopwright {

/// Their values either exist already, or are created one by one and freed after reading: all values of a
/// large diagram at once would exceed the caches.
class BlockList {
 public:
  /// From the member "blocks"; null: it is absent.
  explicit BlockList(const Value::Member* blocks) : values_(blocks ? &blocks->value : nullptr) {}
  explicit BlockList(const JsonTokens& tokens)
      : tokens_(&tokens), token_(tokens.find("blocks").value_or(0)) {}

  size_t size() const {
    if (tokens_) return is_there() ? inside().values : 0;
    return values_ ? values_->members.size() : 0;
  }

  /// Calls read(member) for every block until it returns false.
  template <class Read> void each(Read&& read) const {
    if (tokens_) {
      for (size_t i = token_ + 1; i < end(); i = tokens_->after(i))
        if (!read(tokens_->member(i))) return;
    } else if (values_) {
      for (const Value::Member& member : values_->members)
        if (!read(member)) return;
    }
  }
  /// Calls read(name) for every block.
  template <class Read> void each_name(Read&& read) const {
    if (tokens_)
      for (size_t i = token_ + 1; i < end(); i = tokens_->after(i))
        read(tokens_->text(tokens_->list[i].name));
    else if (values_)
      for (const Value::Member& member : values_->members) read(std::string_view(member.name));
  }

 private:
  bool is_there() const { return token_ > 0 && tokens_->list[token_].kind == Value::Kind::object; }
  const JsonToken::Inside& inside() const { return tokens_->list[token_].inside; }
  size_t end() const { return is_there() ? inside().end : 0; }

  const Value* values_ = nullptr;
  const JsonTokens* tokens_ = nullptr;
  size_t token_ = 0;  // of the object "blocks"; 0: it is absent
};

}  // namespace loopwright
