//! A stream over a state in memory.

use std::ffi::c_void;
use std::sync::Mutex;
use vst3::Class;
use vst3::Steinberg::{
    IBStream, IBStream_::IStreamSeekMode, IBStream_::IStreamSeekMode_, IBStreamTrait, kInvalidArgument, kResultOk,
    tresult,
};

/// The bytes, and the read or write position.
pub(super) struct Stream(Mutex<(Vec<u8>, usize)>);

impl Class for Stream {
    type Interfaces = (IBStream,);
}

impl Stream {
    pub(super) fn new(bytes: Vec<u8>) -> Self {
        Self(Mutex::new((bytes, 0)))
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        self.0.lock().unwrap().0.clone()
    }
}

impl IBStreamTrait for Stream {
    unsafe fn read(&self, buffer: *mut c_void, wanted: i32, read: *mut i32) -> tresult {
        let (bytes, place) = &mut *self.0.lock().unwrap();
        let count = (wanted.max(0) as usize).min(bytes.len() - *place);
        // SAFETY: the caller provides memory for the requested bytes, and for their number unless that pointer is null.
        unsafe {
            std::ptr::copy_nonoverlapping(bytes[*place..].as_ptr(), buffer.cast::<u8>(), count);
            if let Some(read) = read.as_mut() {
                *read = count as i32;
            }
        }
        *place += count;
        kResultOk
    }

    unsafe fn write(&self, buffer: *mut c_void, count: i32, written: *mut i32) -> tresult {
        let (bytes, place) = &mut *self.0.lock().unwrap();
        // SAFETY: the caller provides the given number of bytes, and memory for their number unless that pointer is
        // null.
        unsafe {
            bytes.truncate(*place);
            bytes.extend_from_slice(std::slice::from_raw_parts(buffer.cast::<u8>(), count.max(0) as usize));
            if let Some(written) = written.as_mut() {
                *written = count.max(0);
            }
        }
        *place = bytes.len();
        kResultOk
    }

    unsafe fn seek(&self, offset: i64, mode: i32, result: *mut i64) -> tresult {
        let (bytes, place) = &mut *self.0.lock().unwrap();
        let from = match mode as IStreamSeekMode {
            IStreamSeekMode_::kIBSeekSet => 0,
            IStreamSeekMode_::kIBSeekCur => *place as i64,
            IStreamSeekMode_::kIBSeekEnd => bytes.len() as i64,
            _ => return kInvalidArgument,
        };
        *place = (from + offset).clamp(0, bytes.len() as i64) as usize;
        // SAFETY: the caller provides memory for the position unless the pointer is null.
        if let Some(result) = unsafe { result.as_mut() } {
            *result = *place as i64;
        }
        kResultOk
    }

    unsafe fn tell(&self, result: *mut i64) -> tresult {
        // SAFETY: as above.
        let Some(result) = (unsafe { result.as_mut() }) else { return kInvalidArgument };
        *result = self.0.lock().unwrap().1 as i64;
        kResultOk
    }
}
