#include "program.h"

#include <errno.h>
#include <string.h>

int index_of(const char* name, const char* const names[], int count) {
  for (int i = 0; i < count; ++i)
    if (strcmp(name, names[i]) == 0) return i;
  fprintf(stderr, "\"%s\" is none of", name);
  for (int i = 0; i < count; ++i) fprintf(stderr, " %s", names[i]);
  fputc('\n', stderr);
  return -1;
}

FILE* create(const char* folder, const char* name) {
  char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE* file = fopen(path, "w");
  if (!file) fprintf(stderr, "%s: %s\n", path, strerror(errno));
  return file;
}

bool done(FILE* file) {
  const bool good = !ferror(file);
  return fclose(file) == 0 && good;
}
