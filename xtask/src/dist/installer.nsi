; The installer for Windows: the command, the plugin and the program for all users. Made by `cargo xtask dist`, which defines
; VERSION, STAGE (the folder with the files) and OUT. Silent with /S; the uninstaller too.

Unicode true
Target amd64-unicode
SetCompressor /SOLID lzma
!include LogicLib.nsh
!include WinMessages.nsh

Name "Sprung"
OutFile "${OUT}"
InstallDir "$PROGRAMFILES64\Sprung"
InstallDirRegKey HKLM "Software\Sprung" "Folder"
RequestExecutionLevel admin
VIProductVersion "${VERSION}.0"
VIAddVersionKey "ProductName" "Sprung"
VIAddVersionKey "ProductVersion" "${VERSION}"
VIAddVersionKey "FileVersion" "${VERSION}"
VIAddVersionKey "FileDescription" "Installs Sprung"
VIAddVersionKey "LegalCopyright" "MIT or Apache-2.0"

Page components
Page directory
Page instfiles
UninstPage uninstConfirm
UninstPage instfiles

!define ENTRY "Software\Microsoft\Windows\CurrentVersion\Uninstall\Sprung"
!define COMMAND_ON_PATH ";$INSTDIR\bin"

; The search path lies in memory of its own: texts of NSIS end at 1,024 characters, and a longer path would lose its end.
; $0 is the registry's key, $1 the value's type, $2 its bytes, $3 the memory with room for one more folder, $4 the place of
; our folder in it, or 0.
!macro ReadPath
    StrCpy $4 0
    System::Call 'advapi32::RegOpenKeyExW(p -2147483646, w "SYSTEM\CurrentControlSet\Control\Session Manager\Environment", \
        i 0, i 0x2001F, *p .r0) i .r5'
    ${If} $5 = 0
        System::Call 'advapi32::RegQueryValueExW(p r0, w "Path", p 0, *i .r1, p 0, *i .r2) i .r5'
        IntOp $6 $2 + 2050
        System::Alloc $6
        Pop $3
        System::Call 'advapi32::RegQueryValueExW(p r0, w "Path", p 0, p 0, p r3, *i r2) i .r5'
        System::Call 'shlwapi::StrStrIW(p r3, w "${COMMAND_ON_PATH}") p .r4'
    ${EndIf}
!macroend

; Only a path that was read ($5 is 0) is written.
!macro WritePath
    System::Call 'kernel32::lstrlenW(p r3) i .r2'
    IntOp $2 $2 + 1
    IntOp $2 $2 * 2
    System::Call 'advapi32::RegSetValueExW(p r0, w "Path", i 0, i r1, p r3, i r2)'
    SendMessage ${HWND_BROADCAST} ${WM_SETTINGCHANGE} 0 "STR:Environment" /TIMEOUT=5000
!macroend

!macro ClosePath
    System::Free $3
    System::Call 'advapi32::RegCloseKey(p r0)'
!macroend

Section "Licences and manual"
    SectionIn RO
    SetRegView 64
    SetShellVarContext all
    SetOutPath "$INSTDIR"
    File "${STAGE}/README.md" "${STAGE}/CHANGELOG.md" "${STAGE}/LICENSE-APACHE" "${STAGE}/LICENSE-MIT"
    File "${STAGE}/LICENSES-OF-CRATES.txt"
    SetOutPath "$INSTDIR\manual"
    File /r "${STAGE}/manual/*.*"
    WriteUninstaller "$INSTDIR\uninstall.exe"
    WriteRegStr HKLM "Software\Sprung" "Folder" "$INSTDIR"
    WriteRegStr HKLM "${ENTRY}" "DisplayName" "Sprung"
    WriteRegStr HKLM "${ENTRY}" "DisplayVersion" "${VERSION}"
    WriteRegStr HKLM "${ENTRY}" "Publisher" "The Sprung authors"
    WriteRegStr HKLM "${ENTRY}" "InstallLocation" "$INSTDIR"
    WriteRegStr HKLM "${ENTRY}" "UninstallString" '"$INSTDIR\uninstall.exe"'
    WriteRegStr HKLM "${ENTRY}" "QuietUninstallString" '"$INSTDIR\uninstall.exe" /S'
    WriteRegDWORD HKLM "${ENTRY}" "NoModify" 1
    WriteRegDWORD HKLM "${ENTRY}" "NoRepair" 1
SectionEnd

Section "Command, on the search path"
    SetOutPath "$INSTDIR\bin"
    File "${STAGE}/bin/sprung.exe"
    SetOutPath "$INSTDIR\completions"
    File /r "${STAGE}/completions/*.*"
    !insertmacro ReadPath
    ${If} $5 = 0
        ${If} $4 = 0
            System::Call 'kernel32::lstrcatW(p r3, w "${COMMAND_ON_PATH}")'
            !insertmacro WritePath
        ${EndIf}
        !insertmacro ClosePath
    ${Else}
        DetailPrint "The search path cannot be read: $INSTDIR\bin is not on it."
    ${EndIf}
SectionEnd

!ifdef PLUGIN
Section "Plugin, as CLAP"
    SetOutPath "$COMMONFILES64\CLAP"
    File "${STAGE}/Sprung.clap"
SectionEnd

Section "Plugin, as VST3"
    SetOutPath "$COMMONFILES64\VST3"
    File /r "${STAGE}/Sprung.vst3"
SectionEnd

Section "Program with a window"
    SetOutPath "$INSTDIR\bin"
    File "${STAGE}/bin/sprung-standalone.exe"
    CreateShortcut "$SMPROGRAMS\Sprung.lnk" "$INSTDIR\bin\sprung-standalone.exe"
SectionEnd
!endif

; Only what the installer has put there is removed.
Section "Uninstall"
    SetRegView 64
    SetShellVarContext all
    !insertmacro ReadPath
    ${If} $5 = 0
        ${If} $4 <> 0
            System::Call 'kernel32::lstrlenW(w "${COMMAND_ON_PATH}") i .r6'
            IntOp $6 $6 * 2
            IntPtrOp $6 $4 + $6
            System::Call 'kernel32::lstrlenW(p r6) i .r7'
            IntOp $7 $7 + 1
            IntOp $7 $7 * 2
            System::Call 'kernel32::RtlMoveMemory(p r4, p r6, p r7)'
            !insertmacro WritePath
        ${EndIf}
        !insertmacro ClosePath
    ${EndIf}
    Delete "$SMPROGRAMS\Sprung.lnk"
    Delete "$COMMONFILES64\CLAP\Sprung.clap"
    RMDir "$COMMONFILES64\CLAP"
    RMDir /r "$COMMONFILES64\VST3\Sprung.vst3"
    RMDir "$COMMONFILES64\VST3"
    Delete "$INSTDIR\bin\sprung.exe"
    Delete "$INSTDIR\bin\sprung-standalone.exe"
    RMDir "$INSTDIR\bin"
    RMDir /r "$INSTDIR\completions"
    RMDir /r "$INSTDIR\manual"
    Delete "$INSTDIR\README.md"
    Delete "$INSTDIR\CHANGELOG.md"
    Delete "$INSTDIR\LICENSE-APACHE"
    Delete "$INSTDIR\LICENSE-MIT"
    Delete "$INSTDIR\LICENSES-OF-CRATES.txt"
    Delete "$INSTDIR\uninstall.exe"
    RMDir "$INSTDIR"
    DeleteRegKey HKLM "${ENTRY}"
    DeleteRegKey HKLM "Software\Sprung"
SectionEnd
