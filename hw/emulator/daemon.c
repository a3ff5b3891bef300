/* The world in a process of its own: motor and watchdog continue when the controlling process is killed.
 *
 *   hil_emulator_daemon WORLD_FILE [SETTINGS.json]
 *
 * Programs that load the emulated library with HIL_EMU_SHARED=WORLD_FILE work on this world, in real time. On
 * standard input, "get NAME" and "set NAME VALUE", one per line, access the card's internal state. End of input
 * ends the daemon. */
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "world.h"

static struct world* create(const char* path, const char* settings) {
  const int file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
  if (file < 0 || ftruncate(file, sizeof(struct world)) != 0) return NULL;
  struct world* w = mmap(NULL, sizeof *w, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  close(file);
  if (w == MAP_FAILED) return NULL;
  world_create_shared(w);
  if (settings && !settings_read(w, settings)) return NULL;
  w->is_real_time = 1;
  return w;
}

static void answer(const char* line) {
  char name[64];
  double value = 0;
  struct world* w = world_lock();
  if (sscanf(line, "set %63s %lf", name, &value) == 2)
    printf("%s\n", setting_set(w, name, value) ? "ok" : "unknown");
  else if (sscanf(line, "get %63s", name) == 1 && setting_get(w, name, &value))
    printf("%.17g\n", value);
  else
    printf("unknown\n");
  world_unlock(w);
  fflush(stdout);
}

int main(int count, char** arguments) {
  if (count < 2 || !create(arguments[1], count > 2 ? arguments[2] : NULL)) {
    fprintf(stderr, "usage: hil_emulator_daemon WORLD_FILE [SETTINGS.json]\n");
    return 2;
  }
  setenv("HIL_EMU_SHARED", arguments[1], 1);
  printf("ready\n");
  fflush(stdout);
  char line[256];
  for (;;) {
    struct pollfd input = {STDIN_FILENO, POLLIN, 0};
    if (poll(&input, 1, 20) == 0)
      world_unlock(world_lock()); /* advances to the present time */
    else if (fgets(line, sizeof line, stdin))
      answer(line);
    else
      return 0;
  }
}
