// A master of MTS-ESP as its shared library shows it to clients, and what the test tells it.

#include <stdbool.h>

static double table[128];
static bool present;
static int left_out = -1, clients;

void MTS_RegisterClient(void) { clients++; }
void MTS_DeregisterClient(void) { clients--; }
bool MTS_HasMaster(void) { return present; }
bool MTS_ShouldFilterNote(char key, signed char channel) { return channel >= 0 && key == left_out; }
const double *MTS_GetTuningTable(void) { return table; }

void test_tune(int key, double frequency) { table[key] = frequency; }
void test_be_present(bool is) { present = is; }
void test_leave_out(int key) { left_out = key; }
int test_clients(void) { return clients; }
