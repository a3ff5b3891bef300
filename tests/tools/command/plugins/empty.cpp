// A library without a registered block.
extern "C" int nothing() { return 0; }
