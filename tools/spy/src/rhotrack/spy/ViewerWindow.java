// SPDX-License-Identifier: MIT
package rhotrack.spy;

import java.awt.GraphicsConfiguration;
import java.awt.Insets;
import java.awt.Rectangle;
import java.awt.Toolkit;
import java.awt.Window;
import java.awt.event.WindowAdapter;
import java.awt.event.WindowEvent;
import javax.swing.JFrame;
import javax.swing.WindowConstants;

import rhotrack.spy.scene.LcmSubscription;
import rhotrack.spy.scene.Model;

/** The viewer's window; closing it also closes its LCM subscription. */
final class ViewerWindow {
    private final JFrame frame = new JFrame("rhotrack");
    private final AllViewsPanel panel;

    ViewerWindow(Model model, LcmSubscription feed, int width, int height) {
        panel = new AllViewsPanel(model);
        frame.setDefaultCloseOperation(WindowConstants.DISPOSE_ON_CLOSE);
        frame.setContentPane(panel);
        frame.setSize(width, height);
        frame.setLocationByPlatform(true);
        frame.addWindowListener(new WindowAdapter() {
            @Override
            public void windowClosed(WindowEvent event) {
                panel.stop();
                feed.close();
            }
        });
    }

    /**
     * Places the window beside the other one; moves the other one to the screen's edge only where
     * both do not fit otherwise.
     */
    void placeBeside(Window other) {
        GraphicsConfiguration where = other.getGraphicsConfiguration();
        // area of the desktop's bars
        Insets edges = Toolkit.getDefaultToolkit().getScreenInsets(where);
        Rectangle screen = where.getBounds();
        screen.x += edges.left;
        screen.y += edges.top;
        screen.width -= edges.left + edges.right;
        screen.height -= edges.top + edges.bottom;
        Rectangle moved = new Rectangle(other.getLocationOnScreen(), other.getSize());
        Rectangle place = WindowBesideAnother.beside(screen, moved, frame.getSize());
        if (place == null) {
            moved.x = screen.x;
            place = WindowBesideAnother.beside(screen, moved, frame.getSize());
        }
        if (place != null) { // otherwise the desktop chooses the place
            other.setBounds(moved);
            frame.setLocationByPlatform(false);
            frame.setBounds(place);
        }
    }

    void open() {
        panel.start();
        frame.setVisible(true);
        // shortcuts work only while something in the window has the focus
        panel.requestFocusInWindow();
    }

    boolean isOpen() {
        return frame.isDisplayable();
    }

    void toFront() {
        frame.setExtendedState(frame.getExtendedState() & ~JFrame.ICONIFIED);
        frame.toFront();
    }

    void whenClosed(Runnable job) {
        frame.addWindowListener(new WindowAdapter() {
            @Override
            public void windowClosed(WindowEvent event) {
                job.run();
            }
        });
    }
}
