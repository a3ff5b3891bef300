// A library that somebody forgot to register a block in.
extern "C" int nothing() { return 0; }
