/* Preloaded into the program: as soon as the file $STALLED_DISK exists, write calls on journals block, as on a
 * disk that stalls. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/uio.h>
#include <unistd.h>

static int is_stalled(int file) {
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  const char* flag = getenv("STALLED_DISK");
  if (length < 8 || !flag) return 0;
  path[length] = 0;
  return strcmp(path + length - 8, ".journal") == 0 && access(flag, F_OK) == 0;
}
static void wait_while_stalled(int file) {
  while (is_stalled(file)) usleep(1000);
}

ssize_t writev(int file, const struct iovec* parts, int count) {
  wait_while_stalled(file);
  return ((ssize_t(*)(int, const struct iovec*, int))dlsym(RTLD_NEXT, "writev"))(file, parts, count);
}
int fdatasync(int file) {
  wait_while_stalled(file);
  return ((int (*)(int))dlsym(RTLD_NEXT, "fdatasync"))(file);
}
