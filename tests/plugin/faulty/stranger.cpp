// A shared object that has nothing to do with beambench.
extern "C" int answer() { return 42; }
