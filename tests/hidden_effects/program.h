#ifndef HIDDEN_EFFECTS_PROGRAM_H
#define HIDDEN_EFFECTS_PROGRAM_H

#include <stdbool.h>
#include <stdio.h>

/// Position of the name in the list; -1 with a message on stderr if it is not there.
int index_of(const char* name, const char* const names[], int count);

/// Opens a file of a scenario for writing; null with a message on stderr.
FILE* create(const char* folder, const char* name);

/// Closes the file; false if anything of it could not be written.
bool done(FILE* file);

#endif
