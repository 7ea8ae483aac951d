/* A CLAP host for Windows that opens the plugin's window twenty times, clicks in it, presses keys, and says which it has heard. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <windows.h>

/* What is used of CLAP 1.2: https://github.com/free-audio/clap */
typedef struct { uint32_t numbers[3]; } version;
typedef struct { version clap; bool (*init)(const char *path); void (*deinit)(void); const void *(*get_factory)(const char *id); } entry;
typedef struct { version clap; const char *id; } descriptor;
typedef struct host { version clap; void *data; const char *texts[4]; const void *(*get_extension)(const struct host *, const char *); void (*requests[3])(const struct host *); } host;
typedef struct plugin {
  const descriptor *about;
  void *data;
  bool (*init)(const struct plugin *);
  void (*destroy)(const struct plugin *);
  bool (*activate)(const struct plugin *, double rate, uint32_t least, uint32_t most);
  void (*deactivate)(const struct plugin *);
  void *processing[4];
  const void *(*get_extension)(const struct plugin *, const char *id);
  void (*on_main_thread)(const struct plugin *);
} plugin;
typedef struct factory {
  uint32_t (*count)(const struct factory *);
  const descriptor *(*about)(const struct factory *, uint32_t index);
  const plugin *(*create)(const struct factory *, const host *, const char *id);
} factory;
typedef struct { const char *api; void *handle; } window;
typedef struct {
  void *apis[2];
  bool (*create)(const plugin *, const char *api, bool floats);
  void (*destroy)(const plugin *);
  void *sizes[6];
  bool (*set_parent)(const plugin *, const window *);
  void *more[2];
  bool (*show)(const plugin *);
} gui;

static struct { int down, character, up, close; } heard;
static volatile LONG is_callback_wanted;
static const plugin *instance;
static HWND outer, inner;
static int wrong;

static LRESULT CALLBACK hear(HWND handle, UINT message, WPARAM wparam, LPARAM lparam) {
  heard.down += message == WM_KEYDOWN;
  heard.character += message == WM_CHAR;
  heard.up += message == WM_KEYUP;
  heard.close += message == WM_CLOSE;
  return message == WM_CLOSE ? 0 : DefWindowProcW(handle, message, wparam, lparam);
}

static void ignore(const host *self) {}
static bool refuse_size(const host *self, uint32_t width, uint32_t height) { return false; }
static bool refuse(const host *self) { return false; }
static void closed(const host *self, bool was_destroyed) {}
static const struct {
  void (*hints)(const host *);
  bool (*resize)(const host *, uint32_t width, uint32_t height);
  bool (*show)(const host *);
  bool (*hide)(const host *);
  void (*closed)(const host *, bool was_destroyed);
} windows = {ignore, refuse_size, refuse, refuse, closed};
static const void *extension(const host *self, const char *id) { return strcmp(id, "clap.gui") ? NULL : &windows; }
static void want_callback(const host *self) { InterlockedExchange(&is_callback_wanted, 1); }

/* Runs the loop of messages for some time. */
static void run(int milliseconds) {
  DWORD end = GetTickCount() + milliseconds;
  MSG message;
  while ((LONG)(end - GetTickCount()) > 0) {
    while (PeekMessageW(&message, NULL, 0, 0, PM_REMOVE)) {
      TranslateMessage(&message);
      DispatchMessageW(&message);
    }
    if (InterlockedExchange(&is_callback_wanted, 0)) instance->on_main_thread(instance);
    MsgWaitForMultipleObjects(0, NULL, FALSE, 10, QS_ALLINPUT);
  }
}

static void judge(const char *what, bool is_right) {
  HWND focus = GetFocus();
  const char *name = focus == outer ? "host" : focus == inner ? "plugin" : focus ? "other" : "none";
  printf("%-40s focus: %-6s heard: down %d, character %d, up %d: %s\n", what, name, heard.down, heard.character, heard.up, is_right ? "right" : "WRONG");
  fflush(stdout);
  wrong += !is_right;
}

static void touch(BYTE key, bool is_up) {
  keybd_event(key, MapVirtualKeyW(key, MAPVK_VK_TO_VSC), is_up ? KEYEVENTF_KEYUP : 0, 0);
  run(200);
}

/* Presses a key until the host has heard it as it should, once or not at all: the window may still be drawing what a click has changed. */
static void press(const char *what, BYTE key, int times) {
  bool is_right = false;
  for (int tries = 0; tries < 10 && !is_right; tries++) {
    ZeroMemory(&heard, sizeof heard);
    touch(key, false);
    touch(key, true);
    run(300);
    is_right = heard.down == times && heard.character == times && heard.up == times;
  }
  judge(what, is_right);
}

static void click(int x, int y) {
  POINT place = {x, y};
  ClientToScreen(inner, &place);
  SetCursorPos(place.x, place.y);
  run(300);
  mouse_event(MOUSEEVENTF_LEFTDOWN, 0, 0, 0, 0);
  run(200);
  mouse_event(MOUSEEVENTF_LEFTUP, 0, 0, 0, 0);
  run(1000);
}

int main(int count, char **arguments) {
  HMODULE library = LoadLibraryA(count > 1 ? arguments[1] : "sprung_plugin.dll");
  const entry *clap = library ? (const void *)GetProcAddress(library, "clap_entry") : NULL;
  if (!clap || !clap->init(arguments[1])) return printf("the library cannot be loaded: error %lu\n", GetLastError()), 2;
  const factory *plugins = clap->get_factory("clap.plugin-factory");
  host self = {{{1, 2, 0}}, NULL, {"keys", "keys", "", "1"}, extension, {ignore, ignore, want_callback}};
  instance = plugins->create(plugins, &self, plugins->about(plugins, 0)->id);
  if (!instance || !instance->init(instance) || !instance->activate(instance, 48000, 1, 512)) return printf("no instance\n"), 2;

  WNDCLASSW class = {.lpfnWndProc = hear, .hInstance = GetModuleHandleW(NULL), .lpszClassName = L"keys"};
  RegisterClassW(&class);
  outer = CreateWindowW(L"keys", L"keys", WS_OVERLAPPEDWINDOW | WS_VISIBLE, 20, 20, 1120, 740, NULL, NULL, class.hInstance, NULL);
  const gui *view = instance->get_extension(instance, "clap.gui");
  window parent = {"win32", outer};
  int opened = 0, left = 0;
  for (int times = 0; times < 20; times++) {
    if (!view->create(instance, "win32", false) || !view->set_parent(instance, &parent)) break;
    view->show(instance);
    run(times % 4 * 100);
    opened += GetWindow(outer, GW_CHILD) != NULL;
    view->destroy(instance);
    left += GetWindow(outer, GW_CHILD) != NULL;
  }
  printf("the window opened %d times and stayed %d times\n", opened, left);
  wrong += opened != 20 || left != 0;
  if (!view->create(instance, "win32", false) || !view->set_parent(instance, &parent)) return printf("no window\n"), 2;
  view->show(instance);
  inner = GetWindow(outer, GW_CHILD);
  ShowWindow(inner, SW_SHOW);
  run(3000);

  SetForegroundWindow(outer);
  SetFocus(outer);
  run(500);
  press("Space before anything was clicked", VK_SPACE, 1);
  click(550, 692);
  press("Space after a click on an empty place", VK_SPACE, 1);
  press("A after a click on an empty place", 'A', 1);
  ZeroMemory(&heard, sizeof heard);
  touch(VK_MENU, false);
  touch(VK_F4, false);
  touch(VK_F4, true);
  touch(VK_MENU, true);
  judge("Alt+F4 asks to close once", heard.close == 1);
  /* ‘Browse’: its search field takes the keys at once. */
  click(510, 22);
  press("no Space while words are typed", VK_SPACE, 0);
  press("no B while words are typed", 'B', 0);
  touch(VK_ESCAPE, false);
  touch(VK_ESCAPE, true);
  touch(VK_ESCAPE, false);
  touch(VK_ESCAPE, true);
  press("Space after the browser was closed", VK_SPACE, 1);
  /* A window that is disabled does not get the focus: SetFocus gives null, and leaves the error of an earlier call. */
  ZeroMemory(&heard, sizeof heard);
  SetFocus(NULL);
  EnableWindow(outer, FALSE);
  SetLastError(ERROR_INVALID_WINDOW_HANDLE);
  SendMessageW(inner, WM_LBUTTONDOWN, MK_LBUTTON, MAKELPARAM(550, 692));
  SendMessageW(inner, WM_LBUTTONUP, 0, MAKELPARAM(550, 692));
  EnableWindow(outer, TRUE);
  judge("a click that does not get the focus", GetFocus() != inner);

  view->destroy(instance);
  instance->deactivate(instance);
  instance->destroy(instance);
  clap->deinit();
  return wrong ? 1 : 0;
}
